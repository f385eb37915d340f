// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/back_end.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace psi_slam {

BackEnd::BackEnd(const BackEndOptions& options)
    : options_(options),
      policy_(options.matcher, options.psi, options.loop_matcher, options.genetic),
      factor_(options.psi),
      closer_(options.loop_closure, options.seed),
      consensus_(options.loop_consensus),
      ledger_({options.loop_sigma_m, options.loop_sigma_rad}),
      pool_(options.threads) {}

NodeLoops BackEnd::close(std::size_t node, const KeyframeStore& memory, PoseGraph& graph) {
  matcher_of_node_.push_back(policy_.kind(factor_.value().psi));
  const ChosenMatcher matcher = policy_.matcher(matcher_of_node_.back());
  LoopCloser::Outcome outcome = closer_.close(node, memory, graph, matcher, pool_);
  NodeLoops loops;
  loops.matcher = matcher.kind;
  loops.effort = outcome.effort;
  for (LoopRecord& loop : outcome.loops) {
    const bool waits = loop.verdict == LoopVerdict::kPending;
    for (const std::size_t confirmed : confirmed_by(ledger_.add(std::move(loop)), memory, graph)) {
      const std::optional<double> news = ledger_.accept(confirmed, graph);
      if (!news) continue;
      ++loops.accepted;
      loops.news = std::max(loops.news, *news);
      loops.agreed = loops.agreed || waits;
    }
  }
  factor_.add_frame(loops.accepted);
  return loops;
}

// The loops that are to become constraints now that this one was found: itself when verification accepted it;
// when it waits for others to agree, those that waited and it, if they now do.
std::vector<std::size_t> BackEnd::confirmed_by(std::size_t index, const KeyframeStore& memory,
                                                  const PoseGraph& graph) {
  const LoopRecord& loop = ledger_.loops()[index];
  if (loop.verdict == LoopVerdict::kAccepted) return {index};
  if (loop.verdict != LoopVerdict::kPending) return {};
  const NodeScan& here = memory.nodes[loop.node];
  return consensus_.add(
      {index, here.travelled_m, here.local_T_robot, loop.anchor, loop.anchor_T_node, loop.ambiguity}, graph,
      [&](std::size_t other) { return ledger_.loops()[other].verdict == LoopVerdict::kPending; });
}

std::map<MatcherKind, LoopEffort> BackEnd::run_final_search(const KeyframeStore& memory, PoseGraph& graph,
                                                            const std::function<bool(double)>& progress) {
  const std::set<LoopPair> searched = ledger_.searched_pairs();
  const auto known = [&](std::size_t node, std::size_t local_map) {
    return searched.count({node, local_map}) != 0;
  };
  const auto matcher_of = [&](std::size_t node) { return policy_.matcher(matcher_of_node_[node]); };
  FinalSearchOutcome outcome = final_search(memory, graph, matcher_of, options_.loop_closure.verification,
                                      options_.final_search, known, options_.seed, pool_, progress);
  for (LoopRecord& loop : outcome.loops) {
    const std::size_t entered = ledger_.add(std::move(loop));
    if (ledger_.loops()[entered].verdict == LoopVerdict::kAccepted) ledger_.accept(entered, graph);
  }
  return outcome.effort;
}

bool BackEnd::match_by_hand(const LoopEdit& edit, std::size_t node, const KeyframeStore& memory,
                               PoseGraph& graph) {
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
    candidate.anchor_T_node = graph.pose(node) - graph.pose(memory.local_maps[edit.local_map].anchor);
    candidate.extent = options_.loop_closure.candidates.max_window;
  }
  const auto matcher = make_matcher(edit.matcher, options_.loop_matcher, options_.genetic);
  std::optional<LoopRecord> loop = closer_.match(node, candidate, memory, {edit.matcher, *matcher}, pool_);
  if (!loop) return false;
  if (loop->verdict == LoopVerdict::kPending) loop->verdict = LoopVerdict::kAccepted;
  ledger_.replace(*std::move(loop), graph);
  return true;
}

std::size_t BackEnd::accepted() const {
  return static_cast<std::size_t>(std::count_if(loops().begin(), loops().end(), [](const LoopRecord& loop) {
    return loop.verdict == LoopVerdict::kAccepted;
  }));
}

}  // namespace psi_slam
