// SPDX-License-Identifier: BSD-3-Clause
// Actions of the Edit menu, which change loops by hand, and files of edits.
#include "base/number_text.h"
#include "gui/loop_between_places.h"
#include "gui/palette.h"
#include "loop_inspector.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/user_error.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

using Kind = LoopEdit::Kind;

const char* const kEditFiles = "Edits of loops and of the drawn map (*.edits)|*.edits|All files|*";

const LoopRecord* record_of(const ReplaySnapshot& snapshot, const LoopEdit& edit) {
  const std::vector<LoopRecord>& loops = *snapshot.loops;
  const auto found = std::find_if(loops.rbegin(), loops.rend(),
                                  [&](const LoopRecord& loop) { return same_loop(loop, edit); });
  return found == loops.rend() ? nullptr : &*found;
}

}  // namespace

void MainFrame::bind_edit_commands() {
  on(kUndo, [this] { replay_->undo(); });  // enabled only while a run is open
  on(kRedo, [this] { replay_->redo(); });
  on(kDeleteLoop, [this] { edit_selected(Kind::kDelete); });
  on(kForceLoop, [this] { edit_selected(Kind::kForce); });
  on(kRestoreLoop, [this] { edit_selected(Kind::kRestore); });
  for (std::size_t i = 0; i < kMatcherKinds.size(); ++i)
    on(kMatchLoopBy + static_cast<int>(i), [this, i] { edit_selected(Kind::kMatch, kMatcherKinds[i]); });
  on(kAddLoop, [this] { toggle_adding_loop(); });
  on_file(kOpenEdits, {FileQuestion::Kind::kOpen, "Open edits", kEditFiles, ""}, &MainFrame::open_edits);
  on_file(kSaveEdits, {FileQuestion::Kind::kSave, "Save the edits", kEditFiles, "my.edits"},
          &MainFrame::save_edits);
  canvas_->on.clicked = [this](const mrpt::math::TPoint2D& place) {
    draft_ ? add_point(place) : click_place(place);
  };
  bind_map_tools();
}

void MainFrame::edit_selected(Kind kind, MatcherKind matcher) {
  if (loops_->selected_loop() == nullptr) return;
  const LoopRecord& loop = *loops_->selected_loop();
  LoopEdit edit{kind, loop.frame, loop.local_map};
  edit.matcher = matcher;
  // An edit discards the loops of the final loop search. A forced loop of that search must be matched again.
  edit.of_final_search = kind == Kind::kForce && loop.in_final_search;
  const double window_m = std::max(loop.window.x_m, loop.window.y_m);
  if (kind == Kind::kMatch)
    edit.place = LoopPlace{loop.anchor_T_predicted, {window_m, window_m, loop.window.theta_rad}};
  replay_->edit(edit);
}

void MainFrame::toggle_adding_loop() {
  if (!run_.snapshot || run_.snapshot->map_T_node->empty()) return;
  const bool on = draft_ || !canvas_->pointing();
  stop_pointing();
  if (!on) return;
  canvas_->set_pointing(true);
  GetMenuBar()->Check(kAddLoop, true);
  show_status("Add a loop: click an object that the map shows twice, where it was seen later (Esc cancels)");
}

void MainFrame::stop_pointing() {
  canvas_->set_pointing(false);
  canvas_->show_draft({});
  first_place_.reset();
  draft_.reset();
  GetMenuBar()->Check(kAddLoop, false);
  for (std::size_t i = 0; i < kMapTools.size(); ++i)
    GetMenuBar()->Check(kMapTool + static_cast<int>(i), false);
  show_status(hint_text());
}

void MainFrame::click_place(const mrpt::math::TPoint2D& place) {
  if (!replay_ || !run_.snapshot) return;
  if (!first_place_) {
    first_place_ = place;
    canvas_->show_draft({{place}, false, palette::kMeasure});
    show_status("Add a loop: now click the same object where it was seen earlier (Esc cancels)");
    return;
  }
  const auto edit = loop_between_places(*run_.snapshot, *first_place_, place, MatcherKind::kCsm);
  stop_pointing();
  if (edit)
    replay_->edit(*edit);
  else
    messages_->warn(
        "No loop can be added yet: the only finished local map contains the scan itself. Map "
        "more scans first.");
}

/// Shows the outcome of the newest edit.
void MainFrame::report_edit(const ReplaySnapshot& snapshot) {
  const auto& [number, edit, outcome, undone] = *snapshot.edited;
  const bool made = outcome.state != LoopEditOutcome::State::kImpossible;
  const LoopEdit* const of_loop = std::get_if<LoopEdit>(&edit);
  const LoopRecord* const loop = of_loop != nullptr ? record_of(snapshot, *of_loop) : nullptr;
  std::string words = text_of(edit);
  words.front() = static_cast<char>(std::toupper(words.front()));
  if (of_loop == nullptr && made) return show_status(words + (undone ? ": undone" : ": done"));
  if (!outcome.reason.empty())
    words += ": " + outcome.reason;
  else if (loop != nullptr)
    words += std::string(": ") + state_text(loop->state) +
             (loop->rejection ? ", " + text_of(loop->rejection) : "");
  if (messages_->asks())
    show_status(words);  // the message bar keeps its question
  else
    messages_->say(made ? MessageBar::Kind::kNote : MessageBar::Kind::kWarning, words);
  if (made && loop != nullptr && of_loop->kind == Kind::kMatch)
    loops_->select(static_cast<std::size_t>(loop - snapshot.loops->data()));
}

void MainFrame::enable_edit_commands() {
  const ReplaySnapshot* const snapshot = run_.snapshot.get();
  const bool open = snapshot != nullptr && snapshot->phase != ReplayPhase::kOpening &&
                    snapshot->phase != ReplayPhase::kFailed;
  const LoopRecord* const loop = open ? loops_->selected_loop() : nullptr;
  const auto enable = [this](int command, bool enabled) {
    GetMenuBar()->Enable(command, enabled);
    loops_->enable_action(command, enabled);
  };
  enable(kDeleteLoop, loop != nullptr && !rejected_by(*loop, LoopRejection::Reason::kDeletedByHand));
  enable(kForceLoop, loop != nullptr && !found_nothing(*loop));
  enable(kRestoreLoop, loop != nullptr && loop->by_hand);
  loops_->enable_action(kMatchLoop, loop != nullptr);
  for (std::size_t i = 0; i < kMatcherKinds.size(); ++i)
    enable(kMatchLoopBy + static_cast<int>(i), loop != nullptr);
  enable(kAddLoop, open && !snapshot->map_T_node->empty());
  for (std::size_t i = 0; i < kMapTools.size(); ++i)
    GetMenuBar()->Enable(kMapTool + static_cast<int>(i), open && !snapshot->map_T_node->empty());
  enable(kUndo, open && !snapshot->undo_text.empty());
  enable(kRedo, open && !snapshot->redo_text.empty());
  enable(kOpenEdits, snapshot != nullptr && !snapshot->live);
  // Edits can also be saved after a failure of the run.
  enable(kSaveEdits, snapshot != nullptr && !snapshot->edits->empty());
  const auto title = [&](int command, const char* name, const char* key, const std::string& what) {
    const wxString label =
        wxString::FromUTF8(name) + (what.empty() ? wxString() : ": " + text_of(what)) + key;
    if (GetMenuBar()->GetLabel(command) != label) GetMenuBar()->SetLabel(command, label);
  };
  title(kUndo, "&Undo", "\tCtrl+Z", open ? snapshot->undo_text : "");
  title(kRedo, "&Redo", "\tCtrl+Shift+Z", open ? snapshot->redo_text : "");
}

EditJournal MainFrame::edits() const {
  if (!replay_) return {};
  if (edits_are_pending()) throw UserError("The last edit is still in progress: try again in a moment");
  return *replay_->snapshot()->edits;
}

void MainFrame::open_edits(const std::filesystem::path& file) {
  if (!replay_) return;
  if (is_live())
    return messages_->fail(
        "A live source cannot be mapped again with other edits. Save the session, open it, and open the "
        "edits then.");
  if (!has_unsaved_edits()) return map_again_with(file);
  messages_->warn("Edits have not been saved. Open other edits anyway?",
                  {{"Open other edits", [this, file] { map_again_with(file); }}});
}

void MainFrame::map_again_with(const std::filesystem::path& edits) {
  attempt([&] {
    open(replay_->input().with_edits(EditJournal::read(edits)), Edits::kOfFile);
    messages_->note("Edits read from " + edits.string() + ". Press play to map the log with them.");
  });
}

void MainFrame::save_edits(const std::filesystem::path& file) {
  attempt([&] {
    const EditJournal all = edits();
    all.write(file);
    unsaved_.note_written_edits(all);
    messages_->note("Edits saved in " + file.string() + ". Map with them with psi-slam --edits.");
  });
}

}  // namespace psi_slam
