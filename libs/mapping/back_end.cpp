// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "pose_graph/graduated_non_convexity.h"

namespace psi_slam {

BackEnd::BackEnd(const BackEndOptions& options)
    : options_(options),
      policy_(options.matcher, options.psi, options.loop_matcher, options.genetic),
      factor_(options.psi),
      closer_(options.loop_closure, options.seed),
      consensus_(options.loop_consensus),
      ledger_({options.loop_sigma_m, options.loop_sigma_rad}),
      pool_(options.threads, options.priority) {}

NodeLoops BackEnd::close(std::size_t node, const KeyframeStore& keyframes, PoseGraph& graph) {
  NodeLoops loops;
  const double ms = loop_clock_.time([&] { loops = search(node, keyframes, graph); });
  loops.milliseconds = ms;
  return loops;
}

NodeLoops BackEnd::search(std::size_t node, const KeyframeStore& keyframes, PoseGraph& graph) {
  const NodeMatchers matchers = policy_.matchers(factor_.value().psi);
  LoopCloser::Outcome outcome = closer_.close(node, keyframes, graph, matchers, pool_);
  NodeLoops loops;
  loops.matcher = matchers.by_psi.kind;
  loops.searched = outcome.searched;
  enter(std::move(outcome), keyframes, graph, loops);
  if (loops.searched) factor_.add_search(loops.accepted);
  return loops;
}

// Records the attempts of a node, and makes constraints of those that are accepted or confirmed.
void BackEnd::enter(LoopCloser::Outcome&& outcome, const KeyframeStore& keyframes, PoseGraph& graph,
                    NodeLoops& loops) {
  loops.effort = outcome.effort;
  loops.effort_of = std::move(outcome.effort_of);
  for (LoopRecord& loop : outcome.loops) {
    const bool waits = loop.state == LoopState::kCandidate;
    for (const std::size_t confirmed : confirmed_by(ledger_.add(std::move(loop)), keyframes, graph)) {
      const std::optional<double> residual = ledger_.accept(confirmed, graph);
      if (!residual) continue;
      ++loops.accepted;
      // A match that confirms candidates locates the robot in the map, so the optimisation is urgent.
      schedule_.add_residual(waits ? std::max(*residual, OptimizationSchedule::kUrgentResidual) : *residual);
    }
  }
}

// Searches the wide windows that the last nodes left to later nodes, because no nodes follow: those of the
// nodes whose matches can still confirm each other. Ends early if `progress` was cut short.
LoopEffort BackEnd::search_left_windows(const KeyframeStore& keyframes, PoseGraph& graph,
                                        const NodeMatchers& matchers, FinalProgress& progress) {
  // A reopened map goes on as if this search had not been made.
  const LoopConsensus consensus = consensus_;
  const OptimizationSchedule schedule = schedule_;
  const std::vector<NodeScan>& nodes = keyframes.nodes;
  const auto is_last = [&](std::size_t node) {
    return nodes.back().travelled_m - nodes[node].travelled_m <= options_.loop_consensus.memory_m;
  };
  std::size_t first = nodes.size();
  while (first > 0 && is_last(first - 1)) --first;
  std::set<LoopPair> matched;
  for (const LoopRecord& loop : ledger_.loops())
    if (loop.node >= first) matched.emplace(loop.node, loop.local_map);
  LoopEffort effort;
  for (std::size_t node = first; node < nodes.size() && !progress.cut_short(); ++node) {
    if (is_unplaced(node, keyframes)) continue;
    NodeLoops loops;
    enter(closer_.close_wide(node, keyframes, graph, matchers, pool_,
                             [&](std::size_t local_map) {
                               return matched.count({node, local_map}) != 0;
                             }),
          keyframes, graph, loops);
    effort += loops.effort;
    if (loops.effort.attempts > 0) loop_clock_.leave_out([&] { return progress.at(0); });
  }
  consensus_ = consensus;
  schedule_ = schedule;
  return effort;
}

// Returns the loops to accept after the loop `index` was found. An accepted loop confirms only itself. A
// candidate confirms itself and all candidates that agree with it, if LoopConsensus is satisfied.
std::vector<std::size_t> BackEnd::confirmed_by(std::size_t index, const KeyframeStore& keyframes,
                                               const PoseGraph& graph) {
  const LoopRecord& loop = ledger_.loops()[index];
  if (loop.state == LoopState::kAccepted) return {index};
  if (loop.state != LoopState::kCandidate) return {};
  const NodeScan& here = keyframes.nodes[loop.node];
  return consensus_.add(
      {index, here.travelled_m, here.local_T_robot, loop.anchor, loop.anchor_T_node, loop.ambiguity,
       loop.response, loop.prior},
      graph, [&](std::size_t other) { return ledger_.loops()[other].state == LoopState::kCandidate; });
}

std::optional<double> BackEnd::optimize_if_due(PoseGraph& graph, SparsePoseAdjustment& solver) {
  if (!schedule_.is_due(graph)) return std::nullopt;
  return graph_clock_.time([&] {
    adjustment_.optimize(graph, solver);
    schedule_.optimized(graph);
  });
}

double BackEnd::optimize(PoseGraph& graph, SparsePoseAdjustment& solver) {
  return graph_clock_.time([&] {
    adjustment_.optimize_completely(graph, solver);
    schedule_.optimized(graph);
  });
}

void BackEnd::settle(PoseGraph& graph, SparsePoseAdjustment& solver, KnownLandmarks* known) {
  graph_clock_.time([&] {
    if (known != nullptr) known->switch_off(graph);
    ledger_.settle(graph, solver);
    if (known == nullptr) return;
    known->select(graph, kInlierChi);
    ledger_.settle(graph, solver);
  });
}

std::pair<MatcherKind, LoopEffort> BackEnd::finish_loops(const KeyframeStore& keyframes, PoseGraph& graph,
                                                         SparsePoseAdjustment& solver,
                                                         FinalProgress& progress, KnownLandmarks* known) {
  const NodeMatchers matchers = policy_.matchers(std::numeric_limits<double>::infinity());
  LoopEffort effort;
  loop_clock_.time([&] { effort += search_left_windows(keyframes, graph, matchers, progress); });
  ledger_.reject_candidates();
  settle(graph, solver, known);
  for (int pass = 0; pass < progress.passes() && !progress.cut_short(); ++pass) {
    final_search_clock_.time([&] {
      effort += run_final_search(keyframes, graph, matchers, [&](double share) {
        return final_search_clock_.leave_out([&] { return progress.at(pass + share); });
      });
    });
    settle(graph, solver, known);
  }
  ledger_.reject_candidates();
  return {matchers.by_psi.kind, effort};
}

LoopEffort BackEnd::run_final_search(const KeyframeStore& keyframes, PoseGraph& graph,
                                     const NodeMatchers& matchers,
                                     const std::function<bool(double)>& progress) {
  const std::set<LoopPair> searched = ledger_.searched_pairs();
  const auto known = [&](std::size_t node, std::size_t local_map) {
    return searched.count({node, local_map}) != 0;
  };
  FinalSearchOutcome outcome = final_search(keyframes, graph, matchers, options_.loop_closure.verification,
                                            options_.final_search, known, options_.seed, pool_, progress);
  for (LoopRecord& loop : outcome.loops) {
    const std::size_t entered = ledger_.add(std::move(loop));
    if (ledger_.loops()[entered].state == LoopState::kAccepted) ledger_.accept(entered, graph);
  }
  return outcome.effort;
}

void BackEnd::refine(RefinedScans& scans, PoseGraph& graph, FinalProgress& progress) {
  if (progress.cut_short()) return;
  refinement_clock_.time([&] {
    refine_jointly(scans, options_.joint_refinement, pool_, [&](double share) {
      return refinement_clock_.leave_out([&] { return progress.at(progress.passes() + share); });
    });
    if (graph.root() == 0) {
      const mrpt::math::TPose2D first = scans.map_T_frame[scans.node_frames.front()];
      for (mrpt::math::TPose2D& pose : scans.map_T_frame) pose = compose(graph.pose(0), between(first, pose));
    }
    for (std::size_t node = 0; node < scans.node_frames.size(); ++node)
      graph.set_pose(node, scans.map_T_frame[scans.node_frames[node]]);
  });
}

bool BackEnd::match_by_hand(const LoopEdit& edit, std::size_t node, const KeyframeStore& keyframes,
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
    candidate.anchor_T_node =
        between(graph.pose(keyframes.local_maps[edit.local_map].anchor), graph.pose(node));
    candidate.extent = options_.loop_closure.candidates.max_window;
  }
  const auto matcher = make_matcher(edit.matcher, options_.loop_matcher, options_.genetic);
  std::optional<LoopRecord> loop;
  loop_clock_.time([&] {
    loop = closer_.match(node, candidate, keyframes, {{edit.matcher, *matcher}}, pool_);
  });
  if (!loop) return false;
  if (loop->state == LoopState::kCandidate) loop->state = LoopState::kAccepted;
  ledger_.replace(*std::move(loop), graph);
  return true;
}

std::size_t BackEnd::accepted() const {
  return static_cast<std::size_t>(std::count_if(loops().begin(), loops().end(), [](const LoopRecord& loop) {
    return loop.state == LoopState::kAccepted;
  }));
}

std::vector<StageTiming> BackEnd::stages() const {
  return {loop_clock_.timing(), graph_clock_.timing(), final_search_clock_.timing(),
          refinement_clock_.timing()};
}

}  // namespace psi_slam
