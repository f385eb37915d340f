// SPDX-License-Identifier: BSD-3-Clause
// What the Edit menu does: loops changed by hand.
#include <wx/menu.h>

#include "loop_actions.h"
#include "loop_inspector.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "psi_slam/user_error.h"
#include "replay/loop_between_places.h"
#include "base/number_text.h"
#include "psi_slam/loop_record.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

using Kind = LoopEdit::Kind;

const char* const kEditFiles = "Loop edits (*.edits)|*.edits|All files|*";

std::string capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

const LoopRecord* record_of(const ReplaySnapshot& snapshot, const LoopEdit& edit) {
  const std::vector<LoopRecord>& loops = *snapshot.loops;
  const auto found = std::find_if(loops.rbegin(), loops.rend(),
                                  [&](const LoopRecord& loop) { return same_loop(loop, edit); });
  return found == loops.rend() ? nullptr : &*found;
}

}  // namespace

void MainFrame::bind_edit_commands() {
  on(kUndo, [this] {
    if (replay_) replay_->undo();
  });
  on(kRedo, [this] {
    if (replay_) replay_->redo();
  });
  on(kDeleteLoop, [this] { edit_selected(Kind::kDelete); });
  on(kForceLoop, [this] { edit_selected(Kind::kForce); });
  on(kRestoreLoop, [this] { edit_selected(Kind::kRestore); });
  for (int matcher = 0; matcher < kMatchers; ++matcher)
    on(kMatchLoopBy + matcher, [this, matcher] { edit_selected(Kind::kMatch, matcher_kind_of(matcher)); });
  on(kAddLoop, [this] { toggle_adding_loop(); });
  on(kOpenEdits, [this] {
    if (const auto file = ask_for_file_({FileQuestion::Kind::kOpen, "Open loop edits", kEditFiles, ""}))
      open_edits(*file);
  });
  on(kSaveEdits, [this] {
    const auto file =
        ask_for_file_({FileQuestion::Kind::kSave, "Save the loop edits", kEditFiles, "my.edits"});
    if (file) save_edits(*file);
  });
  canvas_->on_pointed([this](const mrpt::math::TPoint2D& place) { point_at(place); });
}

void MainFrame::edit_selected(Kind kind, MatcherKind matcher) {
  const std::optional<std::size_t> selected = loops_->selected();
  if (!replay_ || !snapshot_ || !selected || *selected >= snapshot_->loops->size()) return;
  const LoopRecord& loop = (*snapshot_->loops)[*selected];
  LoopEdit edit{kind, loop.frame, loop.local_map};
  edit.matcher = matcher;
  // What the last pass found is gone while the map is open again: it is looked for where it was.
  edit.of_final_search = kind == Kind::kForce && loop.in_final_search;
  const double window_m = std::max(loop.window.x_m, loop.window.y_m);
  if (kind == Kind::kMatch)
    edit.place = LoopPlace{loop.anchor_T_predicted, {window_m, window_m, loop.window.theta_rad}};
  replay_->edit(edit);
}

void MainFrame::toggle_adding_loop() {
  if (!snapshot_ || snapshot_->map_T_node->empty()) return;
  const bool on = !canvas_->pointing();
  set_adding_loop(on);
  tell(on ? "Add a loop: click on something that was seen twice, as the later pass shows it (Esc: no more)"
          : hint_text());
}

void MainFrame::set_adding_loop(bool on) {
  canvas_->set_pointing(on);
  first_place_.reset();
  canvas_->show_pointed(std::nullopt);
  GetMenuBar()->Check(kAddLoop, on);
}

void MainFrame::point_at(const mrpt::math::TPoint2D& place) {
  if (!replay_ || !snapshot_) return;
  if (!first_place_) {
    first_place_ = place;
    canvas_->show_pointed(place);
    tell("Add a loop: now click on the same thing as the earlier pass shows it (Esc: no more)");
    return;
  }
  const auto edit = loop_between_places(*snapshot_, *first_place_, place, MatcherKind::kCsm);
  set_adding_loop(false);
  tell(hint_text());
  if (edit)
    replay_->edit(*edit);
  else
    messages_->say(MessageBar::Kind::kWarning,
                   "No loop can be added yet: there is no finished local map but the scan's own");
}

/// What became of the newest edit, once.
void MainFrame::take_edit_news(const ReplaySnapshot& snapshot) {
  if (!snapshot.edited || snapshot.edited->number == told_edit_) return;
  told_edit_ = snapshot.edited->number;
  const auto& [number, edit, outcome] = *snapshot.edited;
  const bool made = outcome.state != LoopEditOutcome::State::kImpossible;
  const LoopRecord* const loop = record_of(snapshot, edit);
  std::string words = capitalized(text_of(edit));
  if (!outcome.reason.empty())
    words += ": " + outcome.reason;
  else if (loop != nullptr)
    words += std::string(": ") + verdict_text(loop->verdict) +
             (loop->verdict == LoopVerdict::kDeleted || !loop->refusal ? "" : ", " + text_of(loop->refusal));
  if (messages_->asks())
    tell(words);  // the question stays
  else
    messages_->say(made ? MessageBar::Kind::kNote : MessageBar::Kind::kWarning, words);
  if (made && edit.kind == Kind::kMatch && loop != nullptr)
    loops_->select(static_cast<std::size_t>(loop - snapshot.loops->data()));
}

void MainFrame::enable_edit_commands(const ReplaySnapshot* snapshot) {
  const bool open = snapshot != nullptr && snapshot->phase != ReplayPhase::kOpening &&
                    snapshot->phase != ReplayPhase::kFailed;
  const std::optional<std::size_t> selected = loops_->selected();
  const LoopRecord* const loop =
      open && selected && *selected < snapshot->loops->size() ? &(*snapshot->loops)[*selected] : nullptr;
  const auto enable = [this](int command, bool enabled) {
    GetMenuBar()->Enable(command, enabled);
    loops_->actions().enable(command, enabled);
  };
  enable(kDeleteLoop, loop != nullptr && loop->verdict != LoopVerdict::kDeleted);
  enable(kForceLoop, loop != nullptr && loop->verdict != LoopVerdict::kNotFound);
  enable(kRestoreLoop, loop != nullptr && loop->by_hand);
  loops_->actions().enable(kMatchLoop, loop != nullptr);
  for (int matcher = 0; matcher < kMatchers; ++matcher) enable(kMatchLoopBy + matcher, loop != nullptr);
  enable(kAddLoop, open && !snapshot->map_T_node->empty());
  enable(kUndo, open && !snapshot->undo_text.empty());
  enable(kRedo, open && !snapshot->redo_text.empty());
  enable(kOpenEdits, snapshot != nullptr);
  enable(kSaveEdits, snapshot != nullptr && !snapshot->edits->empty());  // of a failed run, too
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
  if (edits_are_under_way()) throw UserError("The last edit is still being made: try again once it is");
  return journal_of(*replay_->snapshot()->edits);
}

void MainFrame::open_edits(const std::filesystem::path& file) {
  if (!replay_) return;
  if (!has_unsaved_edits()) return map_again_with(file);
  messages_->say(MessageBar::Kind::kWarning,
                 "Loops edited by hand have not been saved. Open other edits nevertheless?",
                 {{"Open them", [this, file] { map_again_with(file); }}});
}

void MainFrame::map_again_with(const std::filesystem::path& edits) {
  telling_failures([&] {
    open(replay_->input().with_edits(EditJournal::read(edits)), Edits::kOfFile);
    messages_->say(MessageBar::Kind::kNote, "The log is mapped again with the edits of " + edits.string() +
                                                " as soon as it is played");
  });
}

void MainFrame::save_edits(const std::filesystem::path& file) {
  telling_failures([&] {
    const EditJournal all = edits();
    all.write(file);
    unsaved_.note_written_edits(all);
    messages_->say(MessageBar::Kind::kNote,
                   "The edits are in " + file.string() + ": psi-slam takes them with --edits");
  });
}

}  // namespace psi_slam
