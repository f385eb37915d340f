// SPDX-License-Identifier: BSD-3-Clause
// Actions of the window's menus and keys.
#include <wx/log.h>
#include <wx/textentry.h>
#include <wx/toolbar.h>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "loop_inspector.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "psi_slam/user_error.h"
#include "settings_panel.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

using Ask = FileQuestion::Kind;
using Path = std::filesystem::path;

const char* const kLogFiles =
    "Logs and sessions|*.log;*.clf;*.rawlog;*.bag;*.db3;*.mcap;*.gz;*.session|All files|*";
const char* const kSettingsFiles = "Settings (*.ini)|*.ini|All files|*";

}  // namespace

void MainFrame::on(int command, const std::function<void()>& action) {
  Bind(
      wxEVT_MENU, [action](wxCommandEvent&) { action(); }, command);
}

/// Makes a command ask for a file and call `action` with it, unless the user cancels.
void MainFrame::on_file(int command, const FileQuestion& question,
                        const std::function<void(const Path&)>& action) {
  on(command, [this, question, action] {
    if (const auto file = ask_for_file_(question)) action(*file);
  });
}

void MainFrame::bind_commands() {
  bind_file_commands();
  bind_view_commands();
  bind_edit_commands();
  on(kPlayOrPause, [this] { play_or_pause(); });
  on(kStep, [this] { step(); });
  on(kFinish, [this] { finish(); });
  on(kRestart, [this] { restart(); });
  for (std::size_t i = 0; i < kSpeeds.size(); ++i)
    on(kSpeed + static_cast<int>(i), [this, i] { set_speed(kSpeeds[i]); });
  Bind(wxEVT_CHAR_HOOK, [this](wxKeyEvent& event) { press_key(event); });
  on(kShortcuts, [this] { messages_->note(shortcuts_text()); });
  on(kAbout, [this] { wxAboutBox(about_info(), this); });
}

void MainFrame::press_key(wxKeyEvent& event) {
  if (event.GetKeyCode() == WXK_ESCAPE && canvas_->pointing()) return toggle_adding_loop();
  const bool types = dynamic_cast<wxTextEntry*>(wxWindow::FindFocus()) != nullptr;
  const int command = types || event.HasAnyModifiers() ? wxID_NONE : command_of_key(event.GetKeyCode());
  if (command == wxID_NONE || !GetMenuBar()->IsEnabled(command)) {
    event.Skip();
    return;
  }
  wxCommandEvent chosen(wxEVT_MENU, command);
  chosen.SetEventObject(this);
  ProcessWindowEvent(chosen);
}

void MainFrame::bind_file_commands() {
  const auto open_log = [this](const Path& log) { open_other_log(log); };
  on_file(kOpenLog, {Ask::kOpen, "Open a log or a session", kLogFiles, ""}, open_log);
  on_file(kOpenFolder, {Ask::kFolder, "Open the folder of a ROS 2 bag", "", ""}, open_log);
  on_file(kSaveSession, {Ask::kSave, "Save the session", "Sessions (*.session)|*.session", "my.session"},
          [this](const Path& file) { save_session(file); });
  on_file(kResumeWithLog,
          {Ask::kOpen, "Open the last log of the session, or a log that continues it", kLogFiles, ""},
          [this](const Path& log) { resume_with(log); });
  on_file(kOpenSettings, {Ask::kOpen, "Open settings", kSettingsFiles, ""},
          [this](const Path& file) { open_settings(file); });
  on_file(kSaveSettings, {Ask::kSave, "Save the settings", kSettingsFiles, "my.ini"},
          [this](const Path& file) { save_settings(file); });
  on(kResetSettings, [this] { settings_panel_->reset_all(); });
  on_file(kExport, {Ask::kFolder, "Choose a new or empty folder for the results", "", ""},
          [this](const Path& folder) { export_to(folder, false); });
  on_file(kSavePicture, {Ask::kSave, "Save a picture of the map view", "PNG (*.png)|*.png", "view.png"},
          [this](const Path& file) { save_picture(file); });
  on(kQuit, [this] { Close(); });
  Bind(
      wxEVT_MENU,
      [this](wxCommandEvent& event) {
        const auto index = static_cast<std::size_t>(event.GetId() - recent_.GetBaseId());
        if (index < recent_.GetCount()) open_other_log(path_of(recent_.GetHistoryFile(index)));
      },
      recent_.GetBaseId(), recent_.GetBaseId() + recent_.GetMaxFiles());
}

void MainFrame::bind_view_commands() {
  on(kFitMap, [this] { canvas_->show_all(); });
  on(kTopView, [this] { canvas_->look_from_above(); });
  on(kFollow, [this] { canvas_->set_follow(!canvas_->follows()); });
  on(kMeasure, [this] {
    canvas_->set_measuring(!canvas_->measuring());
    GetMenuBar()->Check(kMeasure, canvas_->measuring());
    GetToolBar()->ToggleTool(kMeasure, canvas_->measuring());
    show_status(canvas_->measuring() ? "Drag in the map to measure a distance" : hint_text());
  });
  canvas_->on.followed = [this](bool follows) {
    GetMenuBar()->Check(kFollow, follows);
    GetToolBar()->ToggleTool(kFollow, follows);
  };
  canvas_->on.measured = [this](const Measure& measure) {
    show_status(fixed_text(measure.distance_m(), 2) + " m");
  };
  canvas_->on.failed = [this](const std::string& sentence) { messages_->fail(sentence); };
  for (std::size_t i = 0; i < kMapLayers; ++i)
    on(kLayer + static_cast<int>(i), [this, i] {
      const auto layer = static_cast<MapLayer>(i);
      canvas_->map_scene().set_visible(layer, GetMenuBar()->IsChecked(kLayer + static_cast<int>(i)));
      canvas_->restyle();
    });
  for (const int command : {kRefusedLoops, kLoopsByMatcher, kLoopsByResidual})
    on(command, [this] {
      LoopStyle style;
      style.refused = GetMenuBar()->IsChecked(kRefusedLoops);
      if (GetMenuBar()->IsChecked(kLoopsByResidual)) style.colour = LoopStyle::Colour::kResidual;
      canvas_->map_scene().set_loop_style(style);
      canvas_->restyle();
    });
  for (const auto& [pane, command] : optional_panes())
    on(command, [this, window = pane, id = command] {
      panes_.GetPane(window).Show(GetMenuBar()->IsChecked(id));
      panes_.Update();
    });
  on(kDefaultLayout, [this] {
    layout_->restore_default_panes();
    check_choices();
  });
  panes_.Bind(wxEVT_AUI_PANE_CLOSE, [this](wxAuiManagerEvent& event) {
    for (const auto& [pane, command] : optional_panes())
      if (event.GetPane()->window == pane) GetMenuBar()->Check(command, false);
  });
}

std::array<std::pair<wxWindow*, int>, 3> MainFrame::optional_panes() const {
  return {{{settings_panel_, kPaneSettings}, {loops_, kPaneLoops}, {plots_, kPanePlots}}};
}

void MainFrame::check_choices() {
  wxMenuBar& menu = *GetMenuBar();
  const MapScene& scene = canvas_->map_scene();
  for (std::size_t i = 0; i < kMapLayers; ++i)
    menu.Check(kLayer + static_cast<int>(i), scene.visible(static_cast<MapLayer>(i)));
  menu.Check(kRefusedLoops, scene.loop_style().refused);
  const bool residual = scene.loop_style().colour == LoopStyle::Colour::kResidual;
  menu.Check(residual ? kLoopsByResidual : kLoopsByMatcher, true);
  for (const auto& [pane, command] : optional_panes()) menu.Check(command, panes_.GetPane(pane).IsShown());
}

void MainFrame::save_session(const Path& file) {
  if (replay_) replay_->save_session(file);
}

void MainFrame::open_settings(const Path& file) {
  attempt([&] {
    BoundSettings fresh;  // options that the file does not set have their defaults
    fresh.load(file, {});
    settings_.settings = fresh.settings;
    settings_panel_->refresh();
    const std::vector<std::string> warnings = fresh.table.take_warnings();
    if (warnings.empty())
      messages_->note("Settings read from " + file.string());
    else
      messages_->warn(first_sentences(warnings));
    show_pending_settings();
  });
}

void MainFrame::save_settings(const Path& file) {
  attempt([&] {
    write_text_atomically(file, settings_file_text(settings_.table));
    messages_->note("Settings saved in " + file.string());
  });
}

void MainFrame::save_picture(const Path& file) {
  canvas_->take_picture([this, file](const wxImage& picture) {
    attempt([&] {
      write_atomically(file, [&](const Path& path) {
        const wxLogNull quiet;  // the message bar reports failures
        if (!picture.SaveFile(text_of(path), wxBITMAP_TYPE_PNG))
          throw SystemFailure("cannot write the picture " + file.string());
      });
      messages_->note("Picture saved in " + file.string());
    });
  });
}

}  // namespace psi_slam
