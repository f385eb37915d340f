// SPDX-License-Identifier: BSD-3-Clause
#include "main_frame.h"

#include <wx/button.h>
#include <wx/config.h>
#include <wx/dirdlg.h>
#include <wx/filedlg.h>
#include <wx/numdlg.h>
#include <wx/settings.h>
#include <wx/simplebook.h>
#include <wx/sizer.h>
#include <wx/statbmp.h>
#include <wx/stattext.h>
#include <wx/statusbr.h>
#include <wx/toolbar.h>

#include <cctype>
#include <limits>

#include "icons.h"
#include "live_status.h"
#include "loop_inspector.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "psi_slam/user_error.h"
#include "settings_panel.h"
#include "transport_bar.h"
#include "window_layout.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kRefresh_ms = 50;
constexpr const char* kUnsaved =
    "Some scans or edits have not been exported or saved. Close the window anyway?";
constexpr int kLiveField = 1;  // field of the status bar for the figures of a live source
constexpr int kLiveFieldWidth = 480;
constexpr int kUsualPort = 5000;
constexpr double kLoopDistance_m = 20;  // distance from the camera to a selected loop

/// The page shown in place of the map until a log is open.
wxPanel* make_start_page(wxWindow* parent) {
  auto* page = new wxPanel(parent);
  auto* column = new wxBoxSizer(wxVERTICAL);
  const auto add = [&](wxWindow* item) { column->Add(item, 0, wxALIGN_CENTRE | wxALL, page->FromDIP(12)); };
  column->AddStretchSpacer(2);
  add(new wxStaticBitmap(page, wxID_ANY, program_icon()));
  auto* title = new wxStaticText(page, wxID_ANY, "Open a log to build a map");
  title->SetFont(title->GetFont().Scaled(1.6F).Bold());
  add(title);
  add(new wxStaticText(
      page, wxID_ANY,
      "Drop a file here or open one: a CARMEN log (.log, .clf), an MRPT rawlog (.rawlog), "
      "both plain or compressed,\na ROS bag or a session. Change settings on the right if you "
      "like, then press play.",
      wxDefaultPosition, wxDefaultSize, wxALIGN_CENTRE_HORIZONTAL));
  auto* button = new wxButton(page, wxID_ANY, wxString::FromUTF8("Open log…"));
  button->Bind(wxEVT_BUTTON, [page](wxCommandEvent&) { choose_command(*page, kOpenLog); });
  add(button);
  column->AddStretchSpacer(3);
  page->SetSizer(column);
  return page;
}

AskForFile ask_in_dialogs(wxWindow& parent) {
  return [&parent](const FileQuestion& question) -> std::optional<std::filesystem::path> {
    const wxString title = text_of(question.title);
    const int style = question.kind == FileQuestion::Kind::kSave ? wxFD_SAVE | wxFD_OVERWRITE_PROMPT
                                                                 : wxFD_OPEN | wxFD_FILE_MUST_EXIST;
    const wxString path = question.kind == FileQuestion::Kind::kFolder
                              ? wxDirSelector(title, "", wxDD_DEFAULT_STYLE, wxDefaultPosition, &parent)
                              : wxFileSelector(title, "", text_of(question.proposed_name), "",
                                               text_of(question.wildcard), style, &parent);
    if (path.empty()) return std::nullopt;
    return path_of(path);
  };
}

AskForPort ask_port_in_dialog(wxWindow& parent) {
  return [&parent]() -> std::optional<std::uint16_t> {
    const long port = wxGetNumberFromUser("A program on this computer sends CARMEN lines to this TCP port.",
                                          "Port:", "Receive CARMEN lines", kUsualPort, 1,
                                          std::numeric_limits<std::uint16_t>::max(), &parent);
    if (port < 0) return std::nullopt;
    return static_cast<std::uint16_t>(port);
  };
}

}  // namespace

MainFrame::MainFrame() : wxFrame(nullptr, wxID_ANY, "psi-slam"), recent_(9), timer_(this) {
  SetIcon(program_icon().GetIcon(wxSize(64, 64)));
  SetMinSize(FromDIP(wxSize(720, 480)));
  set_first_size(*this);
  build();
  bind_commands();
  enable_commands();
  ask_for_file_ = ask_in_dialogs(*this);
  ask_for_port_ = ask_port_in_dialog(*this);
  ask_for_speed_ = [this](const SpeedLimit& proposed) { return ask_for_speed(*this, proposed); };
  default_panes_ = panes_.SavePerspective();
  restore_layout(*wxConfigBase::Get(), *this, panes_, canvas_->map_scene());
  check_choices();
  DragAcceptFiles(true);
  Bind(wxEVT_DROP_FILES, [this](wxDropFilesEvent& event) {
    if (event.GetNumberOfFiles() > 0) open_dropped(path_of(event.GetFiles()[0]));
  });
  Bind(wxEVT_TIMER, [this](wxTimerEvent&) { refresh(); });
  Bind(wxEVT_CLOSE_WINDOW, [this](wxCloseEvent& event) { close(event); });
  timer_.Start(kRefresh_ms);
}

void MainFrame::build() {
  auto* recent = new wxMenu;
  recent_.UseMenu(recent);
  recent_.Load(*wxConfigBase::Get());
  SetMenuBar(make_menu_bar(recent));
  CreateStatusBar();
  show_status(hint_text());
  build_toolbar();
  panes_.SetManagedWindow(this);
  wxWindow* const middle = build_middle();
  settings_panel_ = new SettingsPanel(this, settings_,
                                      {[this](const std::string& sentence) { messages_->fail(sentence); },
                                       [this] {
                                         messages_->dismiss();
                                         show_pending_settings();
                                       }});
  loops_ = new LoopInspector(this, [this](std::optional<std::size_t> loop) { choose_loop(loop); });
  plots_ = new PlotPanel(this, [this](std::size_t scan) { go_to(scan); });
  panes_.AddPane(middle, wxAuiPaneInfo().Name("map").CenterPane());
  const auto pane = [](const char* name, const char* title) {
    return wxAuiPaneInfo().Name(name).Caption(title).MaximizeButton(true).PaneBorder(false);
  };
  panes_.AddPane(
      settings_panel_,
      pane("settings", "Settings").Right().Layer(1).Position(0).BestSize(FromDIP(wxSize(390, 420))));
  panes_.AddPane(loops_, pane("loops", "Loops").Bottom().Position(0).BestSize(FromDIP(wxSize(900, 280))));
  panes_.AddPane(plots_,
                 pane("plots", "Plots").Right().Layer(1).Position(1).BestSize(FromDIP(wxSize(390, 460))));
  panes_.Update();
}

wxWindow* MainFrame::build_middle() {
  auto* panel = new wxPanel(this);
  messages_ = new MessageBar(panel);
  middle_ = new wxSimplebook(panel);
  middle_->AddPage(make_start_page(middle_), "");
  canvas_ = new MapCanvas(middle_);
  middle_->AddPage(canvas_, "");
  transport_ = new TransportBar(panel, [this](std::size_t scan) { go_to(scan); });
  auto* column = new wxBoxSizer(wxVERTICAL);
  column->Add(messages_, 0, wxEXPAND);
  column->Add(middle_, 1, wxEXPAND);
  column->Add(transport_, 0, wxEXPAND);
  panel->SetSizer(column);
  return panel;
}

void MainFrame::build_toolbar() {
  const wxColour ink = wxSystemSettings::GetColour(wxSYS_COLOUR_BTNTEXT);
  wxToolBar* bar = CreateToolBar(wxTB_HORIZONTAL | wxTB_FLAT | wxTB_TEXT | wxTB_HORZ_LAYOUT);
  const auto add = [&](int command, const char* label, Icon icon, const char* tip,
                       wxItemKind kind = wxITEM_NORMAL) {
    bar->AddTool(command, label, icon_of(icon, ink), tip, kind);
  };
  add(kOpenLog, "Open", Icon::kOpen, "Open a log or a session (Ctrl+O)");
  add(kRestart, "Restart", Icon::kRestart, "Map the log again from its first scan (Ctrl+R)");
  add(kExport, "Export", Icon::kExport, "Write all results to a folder (Ctrl+E)");
  bar->AddSeparator();
  add(kFitMap, "Fit map", Icon::kFit, "Show the whole map (Home)");
  add(kTopView, "Top view", Icon::kTop, "Look straight down on the map (T)");
  add(kFollow, "Follow", Icon::kFollow, "Keep the robot in the middle of the view (F)", wxITEM_CHECK);
  add(kMeasure, "Measure", Icon::kMeasure, "Measure a distance by dragging in the map (M)", wxITEM_CHECK);
  add(kMapEdits, "Edit map", Icon::kMapEdits, "Erase, draw or mark zones in the map");
  bar->Realize();
}

void MainFrame::refresh() {
  for (const std::string& failure : replay_.tidy()) messages_->fail(failure);
  attempt([this] { session_reader_.serve(); });
  if (!replay_) return;
  const std::shared_ptr<const ReplaySnapshot> snapshot = replay_->snapshot();
  if (snapshot != run_.snapshot) {
    const std::shared_ptr<const ReplaySnapshot> before = std::exchange(run_.snapshot, snapshot);
    loops_->show(snapshot);
    enable_commands();
    static const ReplaySnapshot kOpening;
    report_changes(*snapshot, before ? *before : kOpening);
    canvas_->map_scene().choose_loop(loops_->selected());
  }
  transport_->show(*snapshot, replay_->stamps_us(), run_.frame);
  canvas_->show(snapshot, replay_->drawn_map(), run_.frame);
  plots_->show(snapshot, run_.frame);
  show_live_figures();
}

/// Shows the figures and new notices of a live source in the status bar.
void MainFrame::show_live_figures() {
  const std::optional<LiveFigures> figures = replay_ ? replay_->live_figures() : std::nullopt;
  wxStatusBar& bar = *GetStatusBar();
  const int fields = figures ? kLiveField + 1 : kLiveField;
  const std::array<int, kLiveField + 1> widths{-1, FromDIP(kLiveFieldWidth)};
  if (bar.GetFieldsCount() != fields) bar.SetFieldsCount(fields, widths.data());
  if (!figures) return;
  const wxString text = text_of(live_status(*figures));
  if (bar.GetStatusText(kLiveField) != text) bar.SetStatusText(text, kLiveField);
  if (figures->notices == run_.notices) return;
  run_.notices = figures->notices;
  std::string notice = figures->notice;
  notice.front() = static_cast<char>(std::toupper(notice.front()));
  show_status(notice);
}

/// Shows warnings, failures and outcomes of saves, exports and edits that `before` does not have.
void MainFrame::report_changes(const ReplaySnapshot& snapshot, const ReplaySnapshot& before) {
  const bool saved = is_new(snapshot.saved, before.saved);
  const bool exported = is_new(snapshot.exported, before.exported);
  const bool failed = snapshot.phase == ReplayPhase::kFailed;
  report_warnings(snapshot.warnings);
  if (before.phase == ReplayPhase::kOpening && snapshot.phase != ReplayPhase::kOpening && !failed &&
      !snapshot.live)
    add_to_recent_logs();
  if (saved) report_save(*snapshot.saved);
  if (exported) report_export(*snapshot.exported);
  if (failed && (saved || exported || before.phase != ReplayPhase::kFailed))
    messages_->fail(snapshot.failure);  // the failure of the run makes saves and exports fail, too
  if (snapshot.verdict && snapshot.verdict != before.verdict)
    show_status("Verdict: " + verdict_sentence(*snapshot.verdict) + '.');
  if (is_new(snapshot.edited, before.edited)) report_edit(snapshot);
}

/// Shows new warnings. If only the text of a shown warning has changed, such as a number, updates the text.
void MainFrame::report_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty() || warnings == run_.reported_warnings || messages_->asks()) return;
  if (warnings.size() > run_.reported_warnings.size() ||
      messages_->sentence() == first_sentences(run_.reported_warnings))
    messages_->warn(first_sentences(warnings));
  run_.reported_warnings = warnings;
}

void MainFrame::report_save(const WriteOutcome& outcome) {
  if (!outcome.failure.empty()) return messages_->fail(outcome.failure);
  unsaved_.note_written(outcome.written);
  if (!outcome.remark.empty()) return messages_->warn(outcome.remark);
  messages_->note("Session saved in " + outcome.path.string() +
                  ". Open it here or continue it with psi-slam --resume.");
}

void MainFrame::report_export(const WriteOutcome& outcome) {
  const bool closes = std::exchange(run_.close_when_written, false);
  if (!outcome.failure.empty()) return messages_->fail(outcome.failure);
  unsaved_.note_written(outcome.written);
  messages_->note("All results are in " + outcome.path.string() + ". Start with report.html.");
  if (closes) Close();
}

void MainFrame::enable_commands() {
  const bool open = run_.snapshot != nullptr;
  const ReplayPhase phase = open ? run_.snapshot->phase : ReplayPhase::kOpening;
  const bool mapping = phase == ReplayPhase::kPaused || phase == ReplayPhase::kPlaying;
  const bool searching = phase == ReplayPhase::kFinalSearch;
  const bool finished = phase == ReplayPhase::kFinished;
  const bool has_scans = open && !run_.snapshot->frames.empty();
  const bool live = open && run_.snapshot->live;
  const bool connected = is_connected();
  wxMenuBar& menu = *GetMenuBar();
  for (const int command : {kConnectTcp, kConnectLog, kConnectFolder, kConnectSensors})
    menu.Enable(command, !connected);
  menu.Enable(kDisconnect, connected);
  menu.Enable(kPlayOrPause, (mapping && !live) || searching);
  menu.Enable(kStep, mapping && !live);
  menu.Enable(kFinish, connected || (has_scans && (mapping || searching)));
  menu.Enable(kRestart, open && !live);
  for (int i = 0; i < static_cast<int>(kSpeeds.size()); ++i) menu.Enable(kSpeed + i, !live);
  menu.Enable(kExport, finished);
  menu.Enable(kResumeWithLog, replay_ && replay_->input().recording() != nullptr);
  menu.Enable(kSaveSession, has_scans && (mapping || finished));
  menu.Enable(kSavePicture, open);
  enable_edit_commands();
  GetToolBar()->EnableTool(kRestart, open && !live);
  GetToolBar()->EnableTool(kExport, finished);
  GetToolBar()->EnableTool(kMapEdits, menu.IsEnabled(kMapTool));
}

void MainFrame::play_or_pause() {
  if (!replay_ || !run_.snapshot) return;
  run_.frame.reset();
  TransportBar::can_pause(*run_.snapshot) ? replay_->pause() : replay_->play();
}

void MainFrame::finish() {
  if (!replay_ || !run_.snapshot) return;
  run_.snapshot->phase == ReplayPhase::kFinalSearch ? replay_->cut_final_search() : replay_->finish();
}

void MainFrame::set_speed(int choice) {
  speed_ = kSpeeds.at(static_cast<std::size_t>(choice));
  transport_->set_speed(choice);
  GetMenuBar()->Check(kSpeed + choice, true);
  if (replay_) replay_->set_speed(speed_);
}

void MainFrame::go_to(std::size_t scan) {
  if (!replay_ || !run_.snapshot) return;
  const std::size_t mapped = run_.snapshot->frames.size();
  const ReplayPhase phase = run_.snapshot->phase;
  const bool mapping =
      phase == ReplayPhase::kOpening || phase == ReplayPhase::kPaused || phase == ReplayPhase::kPlaying;
  run_.frame.reset();
  if (scan + 1 < mapped)
    run_.frame = scan;
  else if (scan + 1 > mapped && mapping && !is_live())
    replay_->hurry_to(scan + 1);
  refresh();  // may show the verdict in the status bar
  if (scan + 1 > mapped && !mapping && !is_live())
    show_status("The run was finished after " + std::to_string(mapped) +
                " scans. Press Restart to map later scans.");
}

void MainFrame::choose_loop(std::optional<std::size_t> loop) {
  if (run_.snapshot) enable_edit_commands();
  canvas_->map_scene().choose_loop(loop);
  const LoopRecord* const record = loop ? loops_->selected_loop() : nullptr;
  if (record != nullptr)
    canvas_->look_at(mrpt::math::TPoint2D(run_.snapshot->map_T_node->at(record->node)), kLoopDistance_m);
}

void MainFrame::export_to(const std::filesystem::path& folder, bool replace) {
  if (!replay_) return;
  std::error_code ignored;
  const bool taken =
      std::filesystem::is_directory(folder, ignored) && !std::filesystem::is_empty(folder, ignored);
  if (!taken || replace) return replay_->export_to(folder, replace);
  messages_->warn(
      folder.string() + " is not empty. Replace the results of a run in this folder? Other files are kept.",
      {{"Replace results", [this, folder] { export_to(folder, true); }}});
}

bool MainFrame::edits_are_pending() const {
  return replay_ && replay_->snapshot()->phase != ReplayPhase::kFailed &&
         replay_->edits_asked() > replay_->snapshot()->edits_served;
}

bool MainFrame::has_unsaved_edits() const {
  return replay_ && (edits_are_pending() || unsaved_.any_edits(*replay_->snapshot()));
}

bool MainFrame::is_connected() const {
  if (!run_.snapshot || !run_.snapshot->live) return false;
  return run_.snapshot->phase == ReplayPhase::kOpening || run_.snapshot->phase == ReplayPhase::kPlaying;
}

void MainFrame::ask_before_loss(const std::string& question, const std::string& answer,
                                const std::function<void()>& action) {
  const bool loses_map = is_live() && has_unsaved_work();
  if (!loses_map && !has_unsaved_edits()) return action();
  messages_->warn(
      (loses_map ? "The live map has not been exported or saved. " : "Edits have not been saved. ") +
          question,
      {{answer, action}});
}

bool MainFrame::has_unsaved_work() const {
  return replay_ && (edits_are_pending() || unsaved_.any(*replay_->snapshot()));
}

void MainFrame::close(wxCloseEvent& event) {
  const bool writes = run_.snapshot && run_.snapshot->phase == ReplayPhase::kExporting;
  if (event.CanVeto() && writes) {
    run_.close_when_written = true;
    messages_->note("The window closes when all results are written.");
    return event.Veto();
  }
  const bool asked = messages_->sentence() == kUnsaved || run_.may_close_unsaved;
  if (event.CanVeto() && has_unsaved_work() && !asked && !run_.close_when_written) {
    messages_->warn(kUnsaved, {{"Close without saving", [this] {
                                  run_.may_close_unsaved = true;
                                  Close();
                                }}});
    return event.Veto();
  }
  timer_.Stop();
  save_layout(*wxConfigBase::Get(), *this, panes_, canvas_->map_scene());
  Hide();  // the threads of the run may take a moment to end
  event.Skip();
}

void MainFrame::add_to_recent_logs() {
  std::error_code ignored;
  recent_.AddFileToHistory(text_of(std::filesystem::absolute(opened_, ignored)));
  recent_.Save(*wxConfigBase::Get());
  wxConfigBase::Get()->Flush();
}

void MainFrame::show_status(const std::string& text) {
  SetStatusText(text_of(text));
}

}  // namespace psi_slam
