// SPDX-License-Identifier: BSD-3-Clause
#include "window_layout.h"

#include <wx/display.h>
#include <wx/tokenzr.h>

#include <algorithm>
#include <cstdio>
#include <set>

namespace psi_slam {
namespace {

constexpr long kVersion = 1;  // version of the saved layout; layouts of other versions are ignored
constexpr int kGrip = 80;     // at least this many pixels of the title bar must be on a screen

const char* const kSection = "/window/";  // section of the configuration file

wxString key_of(MapLayer layer) {
  return wxString("layers/") + name_of(layer);
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

/// Reduces the size of a window to the space that the desktop's panels leave on a screen.
wxSize fitted(wxSize size, const wxFrame& frame, int screen) {
  size.DecTo(wxDisplay(static_cast<unsigned>(std::max(0, screen))).GetClientArea().GetSize());
  size.IncTo(frame.GetMinSize());
  return size;
}

void restore_window(const wxConfigBase& config, wxFrame& frame) {
  const auto read = [&](const char* name) { return static_cast<int>(config.ReadLong(name, 0)); };
  const wxSize size = frame.FromDIP(wxSize(read("width"), read("height")));
  const wxPoint corner(read("x"), read("y"));
  if (size.x > 0 && size.y > 0) {
    const bool there = on_a_screen(wxRect(corner, size));
    frame.SetSize(fitted(size, frame, there ? wxDisplay::GetFromPoint(corner) : 0));
    if (there) frame.SetPosition(corner);
  }
  if (config.ReadBool("maximized", false)) frame.Maximize();
}

void restore_panes(const wxString& saved, const wxFrame& frame, wxAuiManager& panes) {
  const wxString present = panes.SavePerspective();
  const bool fits = panes_of(saved) == panes_of(present) && leaves_room(saved, frame.GetSize());
  if (!fits || !panes.LoadPerspective(saved, false)) {
    panes.LoadPerspective(present);
    return;
  }
  wxAuiPaneInfoArray& all = panes.GetAllPanes();
  for (std::size_t i = 0; i < all.GetCount(); ++i)
    if (all[i].IsFloating() && !on_a_screen(wxRect(all[i].floating_pos, all[i].floating_size))) all[i].Dock();
  panes.GetPane("map").Show();
  panes.Update();
}

}  // namespace

void set_first_size(wxFrame& frame) {
  frame.SetSize(fitted(frame.FromDIP(wxSize(1500, 960)), frame, wxDisplay::GetFromWindow(&frame)));
}

void save_layers(wxConfigBase& config, const MapScene& scene) {
  const wxConfigPathChanger section(&config, kSection);
  config.Write("version", kVersion);
  for (std::size_t i = 0; i < kMapLayers; ++i)
    config.Write(key_of(static_cast<MapLayer>(i)), scene.visible(static_cast<MapLayer>(i)));
  config.Write("layers/rejected", scene.loop_style().rejected);
  config.Write("layers/residual", scene.loop_style().colour == LoopStyle::Colour::kResidual);
  config.Flush();
}

void save_layout(wxConfigBase& config, const wxFrame& frame, wxAuiManager& panes, const MapScene& scene) {
  const wxConfigPathChanger section(&config, kSection);
  config.Write("maximized", frame.IsMaximized());
  if (!frame.IsMaximized() && !frame.IsIconized()) {
    const wxRect window(frame.GetPosition(), frame.ToDIP(frame.GetSize()));
    config.Write("x", window.x);
    config.Write("y", window.y);
    config.Write("width", window.width);
    config.Write("height", window.height);
  }
  config.Write("panes", panes.SavePerspective());
  save_layers(config, scene);
}

void restore_layout(wxConfigBase& config, wxFrame& frame, wxAuiManager& panes, MapScene& scene) {
  const wxConfigPathChanger section(&config, kSection);
  if (config.ReadLong("version", 0) != kVersion) return;
  restore_window(config, frame);
  restore_panes(config.Read("panes", ""), frame, panes);
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    const auto layer = static_cast<MapLayer>(i);
    scene.set_visible(layer, config.ReadBool(key_of(layer), shown_at_first(layer)));
  }
  LoopStyle style;
  style.rejected = config.ReadBool("layers/rejected", false);
  if (config.ReadBool("layers/residual", false)) style.colour = LoopStyle::Colour::kResidual;
  scene.set_loop_style(style);
}

}  // namespace psi_slam
