// SPDX-License-Identifier: BSD-3-Clause
// What the menus and keys of the window do.
#include <wx/aboutdlg.h>
#include <wx/log.h>
#include <wx/textentry.h>
#include <wx/toolbar.h>

#include "about_box.h"
#include "loop_inspector.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "base/atomic_file.h"
#include "psi_slam/user_error.h"
#include "base/number_text.h"
#include "settings_panel.h"
#include "transport_bar.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

const char* const kLogFiles =
    "Logs and sessions|*.log;*.clf;*.rawlog;*.bag;*.db3;*.mcap;*.gz;*.session|All files|*";
const char* const kSettingsFiles = "Settings (*.ini)|*.ini|All files|*";

}  // namespace

void MainFrame::on(int command, const std::function<void()>& action) {
  Bind(
      wxEVT_MENU, [action](wxCommandEvent&) { action(); }, command);
}

void MainFrame::bind_commands() {
  bind_file_commands();
  bind_view_commands();
  bind_edit_commands();
  on(kPlayOrPause, [this] { play_or_pause(); });
  on(kStep, [this] { step(); });
  on(kFinish, [this] { finish(); });
  on(kRestart, [this] { restart(); });
  for (std::size_t i = 0; i < TransportBar::speeds().size(); ++i)
    on(kSpeed + static_cast<int>(i), [this, i] { set_speed(TransportBar::speeds()[i]); });
  Bind(wxEVT_CHAR_HOOK, [this](wxKeyEvent& event) { press_key(event); });
  on(kShortcuts, [this] { messages_->say(MessageBar::Kind::kNote, shortcuts_text()); });
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
  on(kOpenLog, [this] { ask_for_log(); });
  on(kOpenFolder, [this] { ask_for_log_folder(); });
  on(kSaveSession, [this] { ask_for_session(); });
  on(kGoOnWithLog, [this] { ask_for_log_of_session(); });
  on(kOpenSettings, [this] { ask_for_settings(false); });
  on(kSaveSettings, [this] { ask_for_settings(true); });
  on(kResetSettings, [this] { settings_panel_->reset_all(); });
  on(kExport, [this] { ask_for_export(); });
  on(kSavePicture, [this] { ask_for_picture(); });
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
  on(kShowAll, [this] { canvas_->show_all(); });
  on(kFromAbove, [this] { canvas_->look_from_above(); });
  on(kFollow, [this] { canvas_->set_follow(!canvas_->follows()); });
  on(kMeasure, [this] {
    canvas_->set_measuring(!canvas_->measuring());
    GetMenuBar()->Check(kMeasure, canvas_->measuring());
    GetToolBar()->ToggleTool(kMeasure, canvas_->measuring());
    tell(canvas_->measuring() ? "Drag in the map to measure" : hint_text());
  });
  canvas_->on_followed([this](bool follows) {
    GetMenuBar()->Check(kFollow, follows);
    GetToolBar()->ToggleTool(kFollow, follows);
  });
  canvas_->on_measured([this](const Measure& measure) { tell(fixed_text(measure.distance_m(), 2) + " m"); });
  canvas_->on_failure(
      [this](const std::string& sentence) { messages_->say(MessageBar::Kind::kError, sentence); });
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
  on(kPaneSettings, [this] { toggle_pane(settings_panel_, GetMenuBar()->IsChecked(kPaneSettings)); });
  on(kPaneLoops, [this] { toggle_pane(loops_, GetMenuBar()->IsChecked(kPaneLoops)); });
  on(kPanePlots, [this] { toggle_pane(plots_, GetMenuBar()->IsChecked(kPanePlots)); });
  on(kDefaultLayout, [this] {
    layout_->restore_default_panes();
    check_choices();
  });
  panes_.Bind(wxEVT_AUI_PANE_CLOSE, [this](wxAuiManagerEvent& event) {
    for (const auto& [window, command] : std::initializer_list<std::pair<wxWindow*, int>>{
             {settings_panel_, kPaneSettings}, {loops_, kPaneLoops}, {plots_, kPanePlots}})
      if (event.GetPane()->window == window) GetMenuBar()->Check(command, false);
  });
}

void MainFrame::check_choices() {
  wxMenuBar& menu = *GetMenuBar();
  const MapScene& scene = canvas_->map_scene();
  for (std::size_t i = 0; i < kMapLayers; ++i)
    menu.Check(kLayer + static_cast<int>(i), scene.visible(static_cast<MapLayer>(i)));
  menu.Check(kRefusedLoops, scene.loop_style().refused);
  const bool residual = scene.loop_style().colour == LoopStyle::Colour::kResidual;
  menu.Check(residual ? kLoopsByResidual : kLoopsByMatcher, true);
  menu.Check(kPaneSettings, panes_.GetPane(settings_panel_).IsShown());
  menu.Check(kPaneLoops, panes_.GetPane(loops_).IsShown());
  menu.Check(kPanePlots, panes_.GetPane(plots_).IsShown());
}

void MainFrame::ask_for_log() {
  if (const auto file = ask_for_file_({FileQuestion::Kind::kOpen, "Open a log or a session", kLogFiles, ""}))
    open_other_log(*file);
}

void MainFrame::ask_for_log_folder() {
  if (const auto folder =
          ask_for_file_({FileQuestion::Kind::kFolder, "Open the folder of a ROS 2 bag", "", ""}))
    open_other_log(*folder);
}

void MainFrame::ask_for_settings(bool save) {
  if (save) {
    const auto file =
        ask_for_file_({FileQuestion::Kind::kSave, "Save the settings", kSettingsFiles, "my.ini"});
    if (file) save_settings(*file);
  } else if (const auto file =
                 ask_for_file_({FileQuestion::Kind::kOpen, "Open settings", kSettingsFiles, ""})) {
    open_settings(*file);
  }
}

void MainFrame::ask_for_export() {
  const auto folder =
      ask_for_file_({FileQuestion::Kind::kFolder, "Folder for the results, new or empty", "", ""});
  if (folder) export_to(*folder, false);
}

void MainFrame::ask_for_session() {
  const auto file = ask_for_file_(
      {FileQuestion::Kind::kSave, "Save the session", "Sessions (*.session)|*.session", "my.session"});
  if (file) save_session(*file);
}

void MainFrame::ask_for_log_of_session() {
  if (const auto file =
          ask_for_file_({FileQuestion::Kind::kOpen, "The session's last log, or one that goes on behind it",
                         kLogFiles, ""}))
    go_on_with(*file);
}

void MainFrame::save_session(const std::filesystem::path& file) {
  if (replay_) replay_->save_session(file);
}

void MainFrame::ask_for_picture() {
  const auto file = ask_for_file_(
      {FileQuestion::Kind::kSave, "Save a picture of the view", "PNG (*.png)|*.png", "view.png"});
  if (file) save_picture(*file);
}

void MainFrame::open_settings(const std::filesystem::path& file) {
  telling_failures([&] {
    BoundSettings fresh;  // what the file does not set has its default
    fresh.load(file, {});
    settings_.settings = fresh.settings;
    settings_panel_->refresh();
    messages_->say(MessageBar::Kind::kNote, "The settings are those of " + file.string());
    show_pending_settings();
  });
}

void MainFrame::save_settings(const std::filesystem::path& file) {
  telling_failures([&] {
    write_text_atomically(file, settings_file_text(settings_.table));
    messages_->say(MessageBar::Kind::kNote, "The settings are in " + file.string());
  });
}

void MainFrame::save_picture(const std::filesystem::path& file) {
  canvas_->take_picture([this, file](const wxImage& picture) {
    telling_failures([&] {
      write_atomically(file, [&](const std::filesystem::path& path) {
        const wxLogNull quiet;  // what goes wrong is told in the bar
        if (!picture.SaveFile(text_of(path), wxBITMAP_TYPE_PNG))
          throw SystemFailure("cannot write the picture " + file.string());
      });
      messages_->say(MessageBar::Kind::kNote, "The picture is " + file.string());
    });
  });
}

}  // namespace psi_slam
