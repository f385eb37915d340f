// SPDX-License-Identifier: BSD-3-Clause
#include "main_frame.h"

#include <wx/config.h>
#include <wx/dnd.h>
#include <wx/settings.h>
#include <wx/simplebook.h>
#include <wx/sizer.h>
#include <wx/toolbar.h>

#include "empty_state.h"
#include "first_sentences.h"
#include "icons.h"
#include "loop_inspector.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "psi_slam/user_error.h"
#include "settings_panel.h"
#include "transport_bar.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kBetweenLooks_ms = 50;
constexpr const char* kNotExported =
    "What was mapped or edited since has not been exported. Close the window nevertheless?";
constexpr double kLoopDistance_m = 20;  // of the eye that looks at a chosen loop

class LogDrop : public wxFileDropTarget {
 public:
  explicit LogDrop(MainFrame& frame) : frame_(frame) {}
  bool OnDropFiles(wxCoord, wxCoord, const wxArrayString& names) override {
    if (names.empty()) return false;
    const std::filesystem::path path = path_of(names[0]);
    if (path.extension() == ".ini")
      frame_.open_settings(path);
    else if (path.extension() == ".edits")
      frame_.open_edits(path);
    else
      frame_.open_other_log(path);
    return true;
  }

 private:
  MainFrame& frame_;
};

}  // namespace

MainFrame::MainFrame() : wxFrame(nullptr, wxID_ANY, "psi-slam"), recent_(9), timer_(this) {
  SetIcons(wxIconBundle());
  SetIcon(program_icon().GetIcon(wxSize(64, 64)));
  SetMinSize(FromDIP(wxSize(720, 480)));
  SetSize(FromDIP(wxSize(1500, 960)));
  build();
  bind_commands();
  enable_commands(nullptr);
  ask_for_file_ = ask_in_dialogs(*this);
  layout_.emplace(*this, panes_);
  if (wxConfigBase* config = wxConfigBase::Get(false)) layout_->restore(*config, canvas_->map_scene());
  check_choices();
  SetDropTarget(new LogDrop(*this));
  Bind(wxEVT_TIMER, [this](wxTimerEvent&) { refresh(); });
  Bind(wxEVT_CLOSE_WINDOW, [this](wxCloseEvent& event) { close(event); });
  timer_.Start(kBetweenLooks_ms);
}

MainFrame::~MainFrame() {
  panes_.UnInit();
}

void MainFrame::build() {
  auto* recent = new wxMenu;
  recent_.UseMenu(recent);
  if (wxConfigBase* config = wxConfigBase::Get(false)) recent_.Load(*config);
  SetMenuBar(make_menu_bar(recent));
  CreateStatusBar();
  tell(hint_text());
  build_toolbar();
  panes_.SetManagedWindow(this);
  wxWindow* const middle = build_middle();
  settings_panel_ = new SettingsPanel(
      this, settings_,
      {[this](const std::string& sentence) { messages_->say(MessageBar::Kind::kError, sentence); },
       [this] {
         messages_->dismiss();
         show_pending_settings();
       },
       [this] { restart(); }});
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
  middle_->AddPage(new EmptyState(middle_, [this] { ask_for_log(); }), "");
  canvas_ = new MapCanvas(middle_);
  middle_->AddPage(canvas_, "");
  TransportBar::Actions actions;
  actions.play_or_pause = [this] { play_or_pause(); };
  actions.step = [this] { step(); };
  actions.finish = [this] { finish(); };
  actions.set_speed = [this](double speed) { set_speed(speed); };
  actions.go_to = [this](std::size_t scan) { go_to(scan); };
  transport_ = new TransportBar(panel, std::move(actions));
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
  bar->AddTool(kOpenLog, "Open", icon_of(Icon::kOpen, ink), "Open a log (Ctrl+O)");
  bar->AddTool(kRestart, "Again", icon_of(Icon::kRestart, ink), "Map again from the start (Ctrl+R)");
  bar->AddTool(kExport, "Export", icon_of(Icon::kExport, ink), "Export all results (Ctrl+E)");
  bar->AddSeparator();
  bar->AddTool(kShowAll, "All", icon_of(Icon::kFit, ink), "Show all of the map (Home)");
  bar->AddTool(kFromAbove, "Above", icon_of(Icon::kTop, ink), "Look from above (T)");
  bar->AddCheckTool(kFollow, "Follow", icon_of(Icon::kFollow, ink), wxBitmapBundle(), "Follow the robot (F)");
  bar->AddCheckTool(kMeasure, "Measure", icon_of(Icon::kMeasure, ink), wxBitmapBundle(),
                    "Measure a distance (M): drag in the map");
  bar->Realize();
}

void MainFrame::refresh() {
  for (const std::string& failure : replay_.tidy()) messages_->say(MessageBar::Kind::kError, failure);
  telling_failures([this] { session_reader_.serve(); });
  if (!replay_) return;
  const std::shared_ptr<const ReplaySnapshot> snapshot = replay_->snapshot();
  if (snapshot != snapshot_) {
    snapshot_ = snapshot;
    loops_->show(snapshot);
    enable_commands(snapshot.get());
    take_news(*snapshot);
    if (!replay_) return;
    take_edit_news(*snapshot);
    canvas_->map_scene().choose_loop(loops_->selected());
  }
  transport_->show(*snapshot, replay_->stamps_us(), shown_frame_);
  canvas_->show(snapshot, replay_->drawn_map(), shown_frame_);
  plots_->show(snapshot, shown_frame_);
}

/// Says what the user is to know, each thing once.
void MainFrame::take_news(const ReplaySnapshot& snapshot) {
  const bool refused = (snapshot.saved && snapshot.saved->number != told_save_) ||
                       (snapshot.exported && snapshot.exported->number != told_export_);
  tell_warnings(snapshot.warnings);
  if (!remembered_ && snapshot.phase != ReplayPhase::kOpening && snapshot.phase != ReplayPhase::kFailed) {
    remembered_ = true;
    remember(opened_);
  }
  if (snapshot.saved && snapshot.saved->number != told_save_) tell_save(*snapshot.saved);
  if (snapshot.exported && snapshot.exported->number != told_export_) tell_export(*snapshot.exported);
  if (snapshot.phase == ReplayPhase::kFailed && (refused || snapshot.failure != told_failure_)) {
    told_failure_ = snapshot.failure;
    messages_->say(MessageBar::Kind::kError, snapshot.failure);  // the reason of all else
  }
}

/// What has been told may grow in numbers: that is shown where it still stands, and not told anew.
void MainFrame::tell_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty() || warnings == told_warnings_ || messages_->asks()) return;
  const bool news = warnings.size() > told_warnings_.size();
  if (news || messages_->sentence() == first_sentences(told_warnings_))
    messages_->say(MessageBar::Kind::kWarning, first_sentences(warnings));
  told_warnings_ = warnings;
}

void MainFrame::tell_save(const SaveOutcome& outcome) {
  told_save_ = outcome.number;
  if (!outcome.failure.empty()) return messages_->say(MessageBar::Kind::kError, outcome.failure);
  unsaved_.note_written(outcome.written);
  if (!outcome.remark.empty()) return messages_->say(MessageBar::Kind::kWarning, outcome.remark);
  messages_->say(MessageBar::Kind::kNote, "The session is " + outcome.file.string() +
                                              ": open it here, or go on with it by psi-slam --resume");
}

void MainFrame::tell_export(const ExportOutcome& outcome) {
  told_export_ = outcome.number;
  const bool closes = std::exchange(close_when_written_, false);
  if (!outcome.failure.empty()) return messages_->say(MessageBar::Kind::kError, outcome.failure);
  unsaved_.note_written(outcome.written);
  messages_->say(MessageBar::Kind::kNote,
                 "All results are in " + outcome.folder.string() + ": begin with report.html");
  if (closes) Close();
}

void MainFrame::enable_commands(const ReplaySnapshot* snapshot) {
  const bool mapping = snapshot != nullptr &&
                       (snapshot->phase == ReplayPhase::kPaused || snapshot->phase == ReplayPhase::kPlaying);
  const bool has_scans = snapshot != nullptr && !snapshot->frames.empty();
  const bool finished = snapshot != nullptr && snapshot->phase == ReplayPhase::kFinished;
  wxMenuBar& menu = *GetMenuBar();
  menu.Enable(kPlayOrPause, mapping || (snapshot != nullptr && snapshot->phase == ReplayPhase::kFinalSearch));
  menu.Enable(kStep, mapping);
  menu.Enable(kFinish, has_scans && (mapping || snapshot->phase == ReplayPhase::kFinalSearch));
  menu.Enable(kRestart, snapshot != nullptr);
  menu.Enable(kExport, finished);
  menu.Enable(kGoOnWithLog, replay_ && replay_->input().recording() != nullptr);
  menu.Enable(kSaveSession, has_scans && (mapping || finished));
  menu.Enable(kSavePicture, snapshot != nullptr);
  enable_edit_commands(snapshot);
  GetToolBar()->EnableTool(kRestart, snapshot != nullptr);
  GetToolBar()->EnableTool(kExport, finished);
}

void MainFrame::play_or_pause() {
  if (!replay_ || !snapshot_) return;
  shown_frame_.reset();
  TransportBar::goes_on(*snapshot_) ? replay_->pause() : replay_->play();
}

void MainFrame::step() {
  shown_frame_.reset();
  if (replay_) replay_->step();
}

void MainFrame::finish() {
  if (!replay_ || !snapshot_) return;
  snapshot_->phase == ReplayPhase::kFinalSearch ? replay_->cut_final_search() : replay_->finish();
}

void MainFrame::set_speed(double speed) {
  speed_ = speed;
  transport_->set_speed(speed);
  for (std::size_t i = 0; i < TransportBar::speeds().size(); ++i)
    if (TransportBar::speeds()[i] == speed) GetMenuBar()->Check(kSpeed + static_cast<int>(i), true);
  if (replay_) replay_->set_speed(speed);
}

void MainFrame::go_to(std::size_t scan) {
  if (!replay_ || !snapshot_) return;
  const std::size_t mapped = snapshot_->frames.size();
  const ReplayPhase phase = snapshot_->phase;
  const bool mapping =
      phase == ReplayPhase::kOpening || phase == ReplayPhase::kPaused || phase == ReplayPhase::kPlaying;
  shown_frame_.reset();
  if (scan + 1 < mapped)
    shown_frame_ = scan;
  else if (scan + 1 > mapped && mapping)
    replay_->hurry_to(scan + 1);
  else if (scan + 1 > mapped)
    tell("The run was finished after " + std::to_string(mapped) + " scans: map again to go beyond them");
  refresh();
}

void MainFrame::choose_loop(std::optional<std::size_t> loop) {
  if (snapshot_) enable_edit_commands(snapshot_.get());
  canvas_->map_scene().choose_loop(loop);
  if (!loop || !snapshot_ || *loop >= snapshot_->loops->size()) return;
  const mrpt::math::TPose2D node = snapshot_->map_T_node->at((*snapshot_->loops)[*loop].node);
  canvas_->look_at({node.x, node.y}, kLoopDistance_m);
}

void MainFrame::export_to(const std::filesystem::path& folder, bool replace) {
  if (!replay_) return;
  std::error_code ignored;
  const bool taken =
      std::filesystem::is_directory(folder, ignored) && !std::filesystem::is_empty(folder, ignored);
  if (taken && !replace)
    messages_->say(MessageBar::Kind::kWarning,
                   folder.string() + " is not empty. Replace the results of a run in it? Other files stay.",
                   {{"Replace the results there", [this, folder] { export_to(folder, true); }}});
  else
    replay_->export_to(folder, replace);
}

bool MainFrame::edits_are_under_way() const {
  return replay_ && replay_->snapshot()->phase != ReplayPhase::kFailed &&
         replay_->edits_asked() > replay_->snapshot()->edits_served;
}

bool MainFrame::has_unsaved_edits() const {
  return replay_ && (edits_are_under_way() || unsaved_.any_edits(*replay_->snapshot()));
}

bool MainFrame::has_unsaved_work() const {
  return replay_ && (edits_are_under_way() || unsaved_.any(*replay_->snapshot()));
}

void MainFrame::close(wxCloseEvent& event) {
  const bool writes = snapshot_ && snapshot_->phase == ReplayPhase::kExporting;
  if (event.CanVeto() && writes) {
    close_when_written_ = true;
    messages_->say(MessageBar::Kind::kNote, "The window closes when all results are written");
    event.Veto();
    return;
  }
  const bool asked = messages_->sentence() == kNotExported || closes_without_export_;
  if (event.CanVeto() && has_unsaved_work() && !asked && !close_when_written_) {
    messages_->say(MessageBar::Kind::kWarning, kNotExported, {{"Close without exporting", [this] {
                                                                 closes_without_export_ = true;
                                                                 Close();
                                                               }}});
    event.Veto();
    return;
  }
  timer_.Stop();
  if (wxConfigBase* config = wxConfigBase::Get(false)) layout_->save(*config, canvas_->map_scene());
  Hide();  // the engine may take a moment to end
  event.Skip();
}

void MainFrame::remember(const std::filesystem::path& log) {
  std::error_code ignored;
  recent_.AddFileToHistory(text_of(std::filesystem::absolute(log, ignored)));
  wxConfigBase* const config = wxConfigBase::Get(false);
  if (config == nullptr) return;
  recent_.Save(*config);
  config->Flush();
}

void MainFrame::tell(const std::string& text) {
  SetStatusText(text_of(text));
}

void MainFrame::toggle_pane(wxWindow* window, bool shown) {
  panes_.GetPane(window).Show(shown);
  panes_.Update();
}

}  // namespace psi_slam
