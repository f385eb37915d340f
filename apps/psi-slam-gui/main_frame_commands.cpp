// SPDX-License-Identifier: BSD-3-Clause
// Actions of the window's menus and keys, except the Edit menu.
#include <wx/config.h>
#include <wx/log.h>
#include <wx/simplebook.h>
#include <wx/textentry.h>
#include <wx/toolbar.h>

#include <new>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "loop_inspector.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "psi_slam/user_error.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"
#include "settings_panel.h"
#include "window_layout.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

using Ask = FileQuestion::Kind;
using Path = std::filesystem::path;

const char* const kLogFiles =
    "Logs and sessions|"
    "*.log;*.clf;*.rawlog;*.bag;*.db3;*.mcap;*.gz;*.bz2;*.xz;*.lz4;*.zst;*.zstd;*.session;*.journal|"
    "All files|*";
const char* const kGrowingFiles =
    "Logs and bags|*.log;*.clf;*.rawlog;*.gz;*.bag;*.active;*.db3;*.mcap|All files|*";
const char* const kSettingsFiles = "Settings (*.ini)|*.ini|All files|*";

}  // namespace

void MainFrame::on(int command, const std::function<void()>& action) {
  Bind(
      wxEVT_MENU, [action](wxCommandEvent&) { action(); }, command);
}

/// Makes a command ask for a file and call `action` with it, unless the user cancels.
void MainFrame::on_file(int command, const FileQuestion& question,
                        const std::function<void(MainFrame&, const Path&)>& action) {
  on(command, [this, question, action] {
    if (const auto file = ask_for_file_(question)) action(*this, *file);
  });
}

void MainFrame::bind_commands() {
  bind_file_commands();
  bind_view_commands();
  bind_edit_commands();
  on(kPlayOrPause, [this] { play_or_pause(); });
  on(kStep, [this] {
    run_.frame.reset();
    if (replay_) replay_->step();
  });
  on(kFinish, [this] { finish(); });
  on(kRestart, [this] { restart(); });
  for (int i = 0; i < static_cast<int>(kSpeeds.size()); ++i) on(kSpeed + i, [this, i] { set_speed(i); });
  Bind(wxEVT_CHAR_HOOK, [this](wxKeyEvent& event) { press_key(event); });
  on(kShortcuts, [this] { messages_->note(shortcuts_text()); });
  on(kAbout, [this] { wxAboutBox(about_info(), this); });
}

void MainFrame::press_key(wxKeyEvent& event) {
  if (event.GetKeyCode() == WXK_ESCAPE && canvas_->pointing()) return stop_pointing();
  const bool types = dynamic_cast<wxTextEntry*>(wxWindow::FindFocus()) != nullptr;
  if (!types && !event.HasAnyModifiers() && serve_drawing_key(event.GetKeyCode())) return;
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
  on_file(kOpenLog, {Ask::kOpen, "Open a log or a session", kLogFiles, ""}, &MainFrame::open_other_log);
  on_file(kOpenFolder, {Ask::kFolder, "Open the folder of a ROS 2 bag", "", ""}, &MainFrame::open_other_log);
  on(kConnectTcp, [this] {
    LiveInput source;
    source.kind = LiveInput::Kind::kTcp;
    const std::optional<std::uint16_t> port = ask_for_port_();
    source.port = port.value_or(0);
    if (port) connect_other(source);
  });
  const auto connect_to = [](LiveInput::Kind kind) {
    return [kind](MainFrame& frame, const Path& file) {
      LiveInput source;
      source.kind = kind;
      source.file = file.string();
      frame.connect_other(source);
    };
  };
  on_file(kConnectLog, {Ask::kOpen, "Follow a log or bag that is being recorded", kGrowingFiles, ""},
          connect_to(LiveInput::Kind::kFollow));
  on_file(kConnectFolder, {Ask::kFolder, "Follow the folder of a ROS 2 bag that is being recorded", "", ""},
          connect_to(LiveInput::Kind::kFollow));
  on_file(kConnectSensors,
          {Ask::kOpen, "Open the settings of the sensors, as for rawlog-grabber", kSettingsFiles, ""},
          connect_to(LiveInput::Kind::kSensors));
  on(kDisconnect, [this] { finish(); });
  on_file(kSaveSession, {Ask::kSave, "Save the session", "Sessions (*.session)|*.session", "my.session"},
          &MainFrame::save_session);
  on_file(kResumeWithLog,
          {Ask::kOpen, "Open the last log of the session, or a log that continues it", kLogFiles, ""},
          &MainFrame::resume_with);
  on_file(kOpenSettings, {Ask::kOpen, "Open settings", kSettingsFiles, ""}, &MainFrame::open_settings);
  on_file(kSaveSettings, {Ask::kSave, "Save the settings", kSettingsFiles, "my.ini"},
          &MainFrame::save_settings);
  on(kResetSettings, [this] { settings_panel_->reset_all(); });
  on_file(kExport, {Ask::kFolder, "Choose a new or empty folder for the results", "", ""},
          [](MainFrame& frame, const Path& folder) { frame.export_to(folder, false); });
  on_file(kSavePicture, {Ask::kSave, "Save a picture of the map view", "PNG (*.png)|*.png", "view.png"},
          &MainFrame::save_picture);
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
      show_layers();
    });
  for (const int command : {kRejectedLoops, kLoopsByMatcher, kLoopsByResidual})
    on(command, [this] {
      LoopStyle style;
      style.rejected = GetMenuBar()->IsChecked(kRejectedLoops);
      if (GetMenuBar()->IsChecked(kLoopsByResidual)) style.colour = LoopStyle::Colour::kResidual;
      canvas_->map_scene().set_loop_style(style);
      show_layers();
    });
  for (const auto& [pane, command] : optional_panes())
    on(command, [this, window = pane, id = command] {
      panes_.GetPane(window).Show(GetMenuBar()->IsChecked(id));
      panes_.Update();
    });
  on(kDefaultLayout, [this] {
    panes_.LoadPerspective(default_panes_);
    check_choices();
  });
  panes_.Bind(wxEVT_AUI_PANE_CLOSE, [this](wxAuiManagerEvent& event) {
    for (const auto& [pane, command] : optional_panes())
      if (event.GetPane()->window == pane) GetMenuBar()->Check(command, false);
  });
}

/// Draws the map again after a change of its layers, and remembers them even if the program is killed.
void MainFrame::show_layers() {
  canvas_->restyle();
  save_layers(*wxConfigBase::Get(), canvas_->map_scene());
}

std::array<std::pair<wxWindow*, int>, 3> MainFrame::optional_panes() const {
  return {{{settings_panel_, kPaneSettings}, {loops_, kPaneLoops}, {plots_, kPanePlots}}};
}

void MainFrame::check_choices() {
  wxMenuBar& menu = *GetMenuBar();
  const MapScene& scene = canvas_->map_scene();
  for (std::size_t i = 0; i < kMapLayers; ++i)
    menu.Check(kLayer + static_cast<int>(i), scene.visible(static_cast<MapLayer>(i)));
  menu.Check(kRejectedLoops, scene.loop_style().rejected);
  const bool residual = scene.loop_style().colour == LoopStyle::Colour::kResidual;
  menu.Check(residual ? kLoopsByResidual : kLoopsByMatcher, true);
  for (const auto& [pane, command] : optional_panes()) menu.Check(command, panes_.GetPane(pane).IsShown());
}

void MainFrame::start(const std::string& log, const std::string& config,
                      const std::vector<std::string>& settings, const std::string& edits) {
  std::optional<EditJournal> journal;
  attempt([&] {
    settings_.load(config, settings);
    if (!edits.empty()) journal = EditJournal::read(edits);
  });
  settings_panel_->refresh();
  if (log.empty()) return;
  open_log(log, journal, [=](BoundSettings& bound) { bound.load(config, settings); });
}

void MainFrame::open_log(const Path& log, const std::optional<EditJournal>& edits,
                         const std::function<void(BoundSettings&)>& overrule) {
  const auto open_input = [=](SessionInput input, const std::vector<std::string>& remarks) {
    opened_ = log;
    open(edits ? input.with_edits(*edits) : std::move(input), Edits::kOfFile);
    if (!remarks.empty()) messages_->warn(first_sentences(remarks));
  };
  attempt([&] {
    if (!is_session_file(log)) {
      session_settings_.clear();
      settings_.table.reset_constants();  // a session before may have brought others
      return open_input(SessionInput(log), {});
    }
    const int edits_before = replay_ ? replay_->edits_asked() : 0;
    messages_->note("Reading " + log.string());
    session_reader_.begin(
        [log] { return SessionInput::of_file(log); },
        [=](const SessionInput& input) {
          const auto open_session = [=] {
            std::vector<std::string> remarks = take_settings_of(input.recording()->facts, log, overrule);
            if (const auto& lost = input.recording()->lost_end) remarks.push_back(*lost);
            open_input(input, remarks);
          };
          if (!replay_ || replay_->edits_asked() == edits_before) return open_session();
          messages_->warn("Edits were made while " + log.string() + " was read. Open it anyway?",
                          {{"Open it", [=] { attempt(open_session); }}});
        });
  });
}

/// Replaces the window's settings by the settings of a session. Changes nothing if it throws UserError.
/// Returns remarks for the user.
std::vector<std::string> MainFrame::take_settings_of(const SessionFacts& facts, const Path& file,
                                                     const std::function<void(BoundSettings&)>& overrule) {
  BoundSettings recorded;  // options that the session does not set have their defaults
  std::vector<std::string> remarks = load_recorded(recorded, facts, file);
  if (const auto other = other_version_text(file, facts)) remarks.push_back(*other);
  std::map<std::string, std::string> kept = kept_settings(recorded.table);
  if (overrule) overrule(recorded);
  require_kept(kept, recorded.table, file);
  session_settings_ = std::move(kept);
  settings_.settings = recorded.settings;
  settings_panel_->refresh();
  return remarks;
}

void MainFrame::resume_with(const Path& log) {
  if (!replay_ || !replay_->input().recording()) return;
  attempt([&] {
    messages_->note("Reading " + log.string());
    session_reader_.begin(
        [recording = replay_->input().recording(), log] { return SessionInput(recording, log); },
        [this](const SessionInput& input) { open(input.with_edits(edits()), Edits::kMadeSoFar); });
  });
}

void MainFrame::attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (...) {
    report_failure(std::current_exception());
  }
}

void MainFrame::report_failure(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    messages_->fail("Out of memory: close other programs or map a shorter log");
  } catch (const std::exception& error) {
    messages_->fail(error.what());
  }
}

void MainFrame::open(SessionInput input, Edits edits) {
  if (input.recording()) require_kept(session_settings_, settings_.table, opened_);
  clear_run();
  edits == Edits::kOfFile ? unsaved_.open(input) : unsaved_.restart(input);
  replay_.open(std::move(input), settings_.settings);
  show_run();
}

void MainFrame::connect(const LiveInput& source, const Path& journal) {
  attempt([&] {
    if (std::filesystem::exists(journal))
      throw UserError(journal.string() +
                      " exists and may hold a run that was not finished. Open it with File > Open, or choose "
                      "another file");
    LiveStream stream = live_stream(source, journal);
    opened_ = stream.name;
    session_settings_.clear();
    clear_run();
    unsaved_ = {};
    replay_.open(std::move(stream), settings_.settings);
    show_run();
  });
}

void MainFrame::connect_other(const LiveInput& source) {
  const auto journal = ask_for_file_({Ask::kSave, "Record the run in a journal, in case the program crashes",
                                      "Journals (*.journal)|*.journal", "session.journal"});
  if (!journal) return;
  ask_before_loss("Connect anyway?", "Connect", [this, source, journal] { connect(source, *journal); });
}

void MainFrame::clear_run() {
  session_reader_.give_up();  // a session that is being read belongs to the previous run
  messages_->dismiss();
  run_ = {};
  stop_pointing();
  loops_->show_nothing();
  plots_->show(std::make_shared<ReplaySnapshot>(), {});
  run_.settings = settings_file_text(settings_.table);
  settings_panel_->show_pending(false);
}

void MainFrame::show_run() {
  replay_->set_speed(speed_);
  middle_->SetSelection(kMapPage);
  canvas_->show_all();
  SetTitle(text_of(opened_.filename()) + wxString::FromUTF8(" — psi-slam"));
  refresh();
}

void MainFrame::open_other_log(const Path& log) {
  ask_before_loss("Open another log anyway?", "Open it", [this, log] { open_log(log); });
}

void MainFrame::open_dropped(const Path& file) {
  if (file.extension() == ".ini") return open_settings(file);
  if (file.extension() == ".edits") return open_edits(file);
  open_other_log(file);
}

void MainFrame::show_pending_settings() {
  if (replay_ && !is_live())
    settings_panel_->show_pending(settings_file_text(settings_.table) != run_.settings);
}

void MainFrame::restart() {
  if (replay_ && !is_live())
    attempt([this] { open(replay_->input().with_edits(edits()), Edits::kMadeSoFar); });
}

void MainFrame::save_session(const Path& file) {
  if (replay_) replay_->save_session(file);
}

void MainFrame::open_settings(const Path& file) {
  attempt([&] {
    BoundSettings fresh;  // options that the file does not set have their defaults
    fresh.load(file, {});
    fresh.table.copy_constants(settings_.table);  // those of a session that is open
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
