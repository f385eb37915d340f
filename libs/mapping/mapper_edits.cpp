// SPDX-License-Identifier: BSD-3-Clause
// Edits of loops by hand, during and after mapping.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "mapping/loop_closure/superseded_maps.h"
#include "mapping/mapper_implementation.h"
#include "mapping/scan_place.h"

namespace psi_slam {
namespace {

using State = LoopEditOutcome::State;

/// Returns the scan with its place in the map and its time since the start of its run: "scan 812 at (3.1,
/// -2.0) m, 2:42".
std::string scan_text(std::size_t frame, const std::vector<FrameRecord>& frames,
                      const std::vector<std::size_t>& later_run_frames) {
  const mrpt::math::TPose2D& pose = frames[frame].map_T_robot;
  return "scan " + std::to_string(frame) + " at " + place_text({pose.x, pose.y}) + ", " +
         minutes_text(std::floor(time_in_run_s(frames, later_run_frames, frame)));
}

}  // namespace

LoopEditOutcome Mapper::Implementation::edit(const LoopEdit& edit) {
  wait();
  const auto same = [&](const LoopEdit& other) { return same_loop(edit, other); };
  const auto waited = std::remove_if(waiting_edits_.begin(), waiting_edits_.end(), same);
  const bool any_waited = waited != waiting_edits_.end();
  waiting_edits_.erase(waited, waiting_edits_.end());
  if (any_waited && edit.kind == LoopEdit::Kind::kRestore) return {};
  LoopEditOutcome outcome = judge(edit, result_.frames);
  if (outcome.state == State::kDone) return carry_out(edit);
  if (outcome.state == State::kWaits && edit.kind != LoopEdit::Kind::kRestore) waiting_edits_.push_back(edit);
  return outcome;
}

LoopEditOutcome Mapper::Implementation::judge(const LoopEdit& edit,
                                              const std::vector<FrameRecord>& frames) const {
  const std::string scan = "scan " + std::to_string(edit.frame);
  const std::string map = "local map " + std::to_string(edit.local_map);
  if (!options_.close_loops) return {State::kImpossible, "loop closing is switched off"};
  if (edit.frame >= frames.size()) return {State::kWaits, scan + " has not been mapped"};
  const std::optional<std::size_t> node = frames[edit.frame].node;
  if (!node)
    return {State::kImpossible, scan_text(edit.frame, frames, result_.later_run_frames) +
                                    " is not a node of the graph, because the robot had hardly moved"};
  if (edit.local_map >= keyframes().local_maps.size()) return {State::kWaits, map + " is not finished"};
  const PlacedLocalMap& local_map = keyframes().local_maps[edit.local_map];
  if (*node >= local_map.first_node && *node <= local_map.last_node)
    return {State::kImpossible, scan + " is part of " + map};
  if (edit.kind == LoopEdit::Kind::kMatch && (local_map.is_superseded || is_superseded(*node)))
    return {State::kImpossible,
            (local_map.is_superseded ? map : scan) + " is superseded: the robot passed its place at least " +
                std::to_string(kLaterPasses) +
                " times later, so its scans are not kept. Match a newer scan with a newer "
                "local map"};
  return {};
}

LoopEditOutcome Mapper::Implementation::carry_out(const LoopEdit& edit) {
  auto [outcome, joined] = builder_.carry_out(edit, *result_.frames[edit.frame].node);
  if (outcome.state == State::kImpossible) return outcome;
  for (const std::size_t interruption : joined) result_.interruptions[interruption].found_frame = edit.frame;
  catch_up();
  covariance_.reset();  // the next node's covariance includes the change
  return outcome;
}

// Returns whether the scan and the local map of a waiting edit exist. Does not wait for the back end.
bool Mapper::Implementation::can_serve_waiting_edits() const {
  return std::any_of(waiting_edits_.begin(), waiting_edits_.end(), [&](const LoopEdit& waiting) {
    return waiting.frame < result_.frames.size() && waiting.local_map < result_.local_maps.size();
  });
}

// Carries out the waiting edits whose scan and local map now exist. Keeps the other edits waiting.
void Mapper::Implementation::serve_waiting_edits() {
  for (const LoopEdit& waiting : std::exchange(waiting_edits_, {})) {
    const LoopEditOutcome outcome = edit(waiting);
    if (outcome.state == State::kImpossible)
      impossible_edits_.push_back(text_of(waiting) + ": " + outcome.reason);
  }
}

std::vector<std::string> Mapper::Implementation::unmet_edits() const {
  std::vector<std::string> unmet = impossible_edits_;
  for (const LoopEdit& waiting : waiting_edits_)
    unmet.push_back(text_of(waiting) + ": " + judge(waiting, result_.frames).reason);
  for (const auto& [node, local_map] : builder_.back_end().ledger().forced_in_vain())
    unmet.push_back(text_of({LoopEdit::Kind::kForce, keyframes().nodes[node].frame, local_map}) +
                    ": no match of this scan and local map was found");
  return unmet;
}

// Returns a sentence for each forced loop that the other loops and the path contradict.
std::vector<std::string> Mapper::Implementation::contradicted_forces() {
  std::vector<std::string> sentences;
  for (const auto& [pair, chi] : builder_.contradicted_forces())
    sentences.push_back(
        "the forced loop of " +
        scan_text(keyframes().nodes[pair.first].frame, result_.frames, result_.later_run_frames) +
        " with local map " + std::to_string(pair.second) +
        " holds, but the path and the other loops contradict it by " + fixed_text(chi, 1) +
        " standard deviations: undo the edit if the loop is false");
  return sentences;
}

void Mapper::Implementation::reopen(MappingResult&& result) {
  Checkpoint& before = before_finish_.value();
  builder_.restore(std::move(before.state));
  result_ = std::move(result);
  result_.loops.clear();
  result_.loop_matchers = std::move(before.loop_matchers);
  result_.interruptions = std::move(before.interruptions);
  result_.stages.clear();
  result_.interrupted = false;
  result_.final_search_cut_short = false;
  before_finish_.reset();
}

}  // namespace psi_slam
