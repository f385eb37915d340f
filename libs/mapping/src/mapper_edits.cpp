// SPDX-License-Identifier: BSD-3-Clause
// What a person changes about the loops, while the log is mapped and after its end.
#include <algorithm>
#include <utility>

#include "psi_slam/loop_closure/loop_edit.h"
#include "psi_slam/mapping/mapper.h"

namespace psi_slam {
namespace {

using State = LoopEditOutcome::State;

bool same_pair(const LoopEdit& a, const LoopEdit& b) {
  return a.frame == b.frame && a.local_map == b.local_map;
}

}  // namespace

LoopEditOutcome Mapper::edit(const LoopEdit& edit) {
  const auto same = [&](const LoopEdit& other) { return same_pair(edit, other); };
  const auto waited = std::remove_if(waiting_edits_.begin(), waiting_edits_.end(), same);
  const bool any_waited = waited != waiting_edits_.end();
  waiting_edits_.erase(waited, waiting_edits_.end());
  if (any_waited && edit.kind == LoopEdit::Kind::kRestore) return {};
  LoopEditOutcome outcome = judge(edit);
  if (outcome.state == State::kDone) return carry_out(edit);
  if (outcome.state == State::kWaits && edit.kind != LoopEdit::Kind::kRestore) waiting_edits_.push_back(edit);
  return outcome;
}

// Whether an edit's scan and local map are there.
LoopEditOutcome Mapper::judge(const LoopEdit& edit) const {
  const std::string scan = "scan " + std::to_string(edit.frame);
  const std::string map = "local map " + std::to_string(edit.local_map);
  if (!options_.close_loops) return {State::kImpossible, "loop closing is switched off"};
  if (edit.frame >= result_.frames.size()) return {State::kWaits, scan + " has not been mapped"};
  const std::optional<std::size_t> node = result_.frames[edit.frame].node;
  if (!node) return {State::kImpossible, scan + " is no node of the graph: the robot had hardly moved"};
  if (edit.local_map >= memory_.local_maps.size()) return {State::kWaits, map + " is not finished"};
  const PlacedLocalMap& local_map = memory_.local_maps[edit.local_map];
  if (*node >= local_map.first_node && *node <= local_map.last_node)
    return {State::kImpossible, scan + " is part of " + map};
  return {};
}

LoopEditOutcome Mapper::carry_out(const LoopEdit& edit) {
  const std::size_t node = *result_.frames[edit.frame].node;
  const LoopPair pair{node, edit.local_map};
  LoopEditOutcome outcome;
  switch (edit.kind) {
    case LoopEdit::Kind::kDelete:
      ledger_.remove(pair, graph_);
      break;
    case LoopEdit::Kind::kForce:
      if (!ledger_.force(pair, graph_)) outcome = {State::kWaits, "no match of them has been found yet"};
      break;
    case LoopEdit::Kind::kMatch:
      outcome = match_by_hand(edit, node);
      break;
    case LoopEdit::Kind::kRestore:
      if (!ledger_.restore(pair, graph_)) outcome = {State::kImpossible, "there is nothing to take back"};
      break;
  }
  if (outcome.state == State::kImpossible) return outcome;
  graph_clock_.time([&] { optimize(); });
  follow_graph();
  return outcome;
}

LoopEditOutcome Mapper::match_by_hand(const LoopEdit& edit, std::size_t node) {
  LoopCandidate candidate;
  candidate.local_map = edit.local_map;
  const LoopRecord* const before = ledger_.find({node, edit.local_map});
  if (edit.place) {
    candidate.anchor_T_node = edit.place->anchor_T_node;
    candidate.extent = edit.place->window;
  } else if (before != nullptr) {
    candidate.anchor_T_node = before->anchor_T_predicted;
    candidate.extent = before->window;
  } else {
    candidate.anchor_T_node = graph_.pose(node) - graph_.pose(memory_.local_maps[edit.local_map].anchor);
    candidate.extent = options_.loop_closure.candidates.max_window;
  }
  const auto matcher = make_matcher(edit.matcher, options_.loop_matcher, options_.genetic);
  std::optional<LoopRecord> loop;
  loop_clock_.time([&] { loop = loop_closer_.match(node, candidate, memory_, *matcher, pool_); });
  if (!loop) return {State::kImpossible, "the scan has no returns to match"};
  if (loop->verdict == LoopVerdict::kPending) loop->verdict = LoopVerdict::kAccepted;
  ledger_.replace(*std::move(loop), graph_);
  return {};
}

// Those whose scan and local map have come since.
void Mapper::serve_waiting_edits() {
  for (const LoopEdit& waiting : std::exchange(waiting_edits_, {})) {
    const LoopEditOutcome outcome = edit(waiting);
    if (outcome.state == State::kImpossible)
      impossible_edits_.push_back(text_of(waiting) + ": " + outcome.reason);
  }
}

std::vector<std::string> Mapper::unmet_edits() const {
  std::vector<std::string> unmet = impossible_edits_;
  for (const LoopEdit& waiting : waiting_edits_)
    unmet.push_back(text_of(waiting) + ": " + judge(waiting).reason);
  for (const auto& [node, local_map] : ledger_.forced_in_vain())
    unmet.push_back(text_of({LoopEdit::Kind::kForce, memory_.nodes[node].frame, local_map}) +
                    ": no match of them was found");
  return unmet;
}

void Mapper::reopen(MappingResult&& result) {
  Checkpoint& before = before_finish_.value();
  graph_ = std::move(before.graph);
  ledger_ = std::move(before.ledger);
  solver_ = std::move(before.solver);
  result_ = std::move(result);
  result_.loops.clear();
  result_.loop_matchers = std::move(before.loop_matchers);
  result_.stages.clear();
  result_.interrupted = false;
  result_.last_pass_cut_short = false;
  before_finish_.reset();
}

}  // namespace psi_slam
