// SPDX-License-Identifier: BSD-3-Clause
#include "window_layout.h"

#include <wx/display.h>
#include <wx/tokenzr.h>

#include <algorithm>
#include <cstdio>
#include <set>

namespace psi_slam {
namespace {

constexpr long kVersion = 1;  // of the saved layout; other versions are ignored
constexpr int kGrip = 80;     // at least this many pixels of the title bar must be on a screen

const char* const kSection = "/window/";

wxString key(const std::string& name) {
  return kSection + name;
}

wxString layer_key(std::size_t layer) {
  return key(std::string("layers/") + name_of(static_cast<MapLayer>(layer)));
}

/// The names of the panes in a layout text of wxAUI.
std::set<wxString> panes_of(const wxString& layout) {
  std::set<wxString> names;
  wxStringTokenizer parts(layout, "|;");
  while (parts.HasMoreTokens()) {
    wxString name;
    if (parts.GetNextToken().StartsWith("name=", &name)) names.insert(name);
  }
  return names;
}

/// True if the docks leave the map at least a third of the window's width and height.
bool leaves_room(const wxString& layout, const wxSize& window) {
  wxStringTokenizer parts(layout, "|");
  int across = 0;
  int down = 0;
  while (parts.HasMoreTokens()) {
    int direction = 0;
    int size = 0;
    if (std::sscanf(parts.GetNextToken().utf8_str(), "dock_size(%d,%*d,%*d)=%d", &direction, &size) != 2)
      continue;
    if (direction == wxAUI_DOCK_LEFT || direction == wxAUI_DOCK_RIGHT) across += size;
    if (direction == wxAUI_DOCK_TOP || direction == wxAUI_DOCK_BOTTOM) down += size;
  }
  return 3 * across <= 2 * window.x && 3 * down <= 2 * window.y;
}

/// True if enough of the title bar is on a screen to drag the window.
bool on_a_screen(const wxRect& window) {
  const wxRect title(window.x, window.y, window.width, kGrip);
  for (unsigned i = 0; i < wxDisplay::GetCount(); ++i) {
    const wxRect seen = wxDisplay(i).GetClientArea().Intersect(title);
    if (seen.width >= kGrip && seen.height >= kGrip / 2) return true;
  }
  return false;
}

}  // namespace

WindowLayout::WindowLayout(wxFrame& frame, wxAuiManager& panes)
    : frame_(frame), panes_(panes), default_panes_(panes.SavePerspective()) {}

void WindowLayout::save(wxConfigBase& config, const MapScene& scene) const {
  config.Write(key("version"), kVersion);
  config.Write(key("maximized"), frame_.IsMaximized());
  if (!frame_.IsMaximized() && !frame_.IsIconized()) {
    const wxRect window(frame_.GetPosition(), frame_.ToDIP(frame_.GetSize()));
    config.Write(key("x"), window.x);
    config.Write(key("y"), window.y);
    config.Write(key("width"), window.width);
    config.Write(key("height"), window.height);
  }
  config.Write(key("panes"), panes_.SavePerspective());
  for (std::size_t i = 0; i < kMapLayers; ++i)
    config.Write(layer_key(i), scene.visible(static_cast<MapLayer>(i)));
  config.Write(key("layers/refused"), scene.loop_style().refused);
  config.Write(key("layers/residual"), scene.loop_style().colour == LoopStyle::Colour::kResidual);
  config.Flush();
}

void WindowLayout::restore(wxConfigBase& config, MapScene& scene) {
  if (config.ReadLong(key("version"), 0) != kVersion) return;
  restore_window(config);
  restore_panes(config.Read(key("panes"), ""));
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    const auto layer = static_cast<MapLayer>(i);
    scene.set_visible(layer, config.ReadBool(layer_key(i), shown_at_first(layer)));
  }
  LoopStyle style;
  style.refused = config.ReadBool(key("layers/refused"), false);
  if (config.ReadBool(key("layers/residual"), false)) style.colour = LoopStyle::Colour::kResidual;
  scene.set_loop_style(style);
}

void WindowLayout::restore_window(const wxConfigBase& config) {
  const auto read = [&](const char* name) { return static_cast<int>(config.ReadLong(key(name), 0)); };
  wxSize size = frame_.FromDIP(wxSize(read("width"), read("height")));
  const wxPoint corner(read("x"), read("y"));
  if (size.x > 0 && size.y > 0) {
    const bool there = on_a_screen(wxRect(corner, size));
    const int screen = there ? wxDisplay::GetFromPoint(corner) : 0;
    const wxRect room = wxDisplay(static_cast<unsigned>(std::max(0, screen))).GetClientArea();
    size.DecTo(room.GetSize());
    size.IncTo(frame_.GetMinSize());
    frame_.SetSize(size);
    if (there) frame_.SetPosition(corner);
  }
  if (config.ReadBool(key("maximized"), false)) frame_.Maximize();
}

void WindowLayout::restore_panes(const wxString& saved) {
  const bool fits = panes_of(saved) == panes_of(default_panes_) && leaves_room(saved, frame_.GetSize());
  if (!fits || !panes_.LoadPerspective(saved, false)) {
    restore_default_panes();
    return;
  }
  wxAuiPaneInfoArray& all = panes_.GetAllPanes();
  for (std::size_t i = 0; i < all.GetCount(); ++i)
    if (all[i].IsFloating() && !on_a_screen(wxRect(all[i].floating_pos, all[i].floating_size))) all[i].Dock();
  panes_.GetPane("map").Show();
  panes_.Update();
}

void WindowLayout::restore_default_panes() {
  panes_.LoadPerspective(default_panes_);
}

}  // namespace psi_slam
