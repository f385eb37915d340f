// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/loop_keeper.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "psi_slam/loop_closure/contradicted_loops.h"
#include "psi_slam/pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

constexpr const char* kTooFewAgree = "found in a wide window, and too few other matches agree with it";

std::string contradiction_text(double chi) {
  return "the other constraints contradict it by " + std::to_string(std::lround(chi)) +
         " standard deviations";
}

}  // namespace

LoopKeeper::LoopKeeper(const LoopKeeperOptions& options)
    : options_(options),
      policy_(options.matcher, options.psi, options.loop_matcher, options.genetic),
      factor_(options.psi),
      closer_(options.loop_closure, options.seed),
      consensus_(options.consensus),
      pool_(options.threads) {}

std::size_t LoopKeeper::close(std::size_t node, const PlaceMemory& memory, PoseGraph& graph) {
  matcher_of_node_.push_back(policy_.kind(factor_.value().psi));
  const Matcher& matcher = policy_.matcher(matcher_of_node_.back());
  std::size_t made = 0;
  for (LoopRecord& loop : closer_.close(node, memory, graph, matcher, pool_).loops) {
    loops_.push_back(std::move(loop));
    for (const std::size_t confirmed : confirmed_by(loops_.size() - 1, memory, graph)) {
      accept(confirmed, graph);
      ++made;
    }
  }
  factor_.add_frame(static_cast<int>(made));
  return made;
}

// A loop that verification accepted, or those that waited and this one, if they now agree.
std::vector<std::size_t> LoopKeeper::confirmed_by(std::size_t index, const PlaceMemory& memory,
                                                  const PoseGraph& graph) {
  const LoopRecord& loop = loops_[index];
  if (loop.verdict == LoopVerdict::kAccepted) return {index};
  if (loop.verdict != LoopVerdict::kPending) return {};
  const NodeScan& here = memory.nodes[loop.node];
  LoopConsensus::Vote vote;
  vote.loop = index;
  vote.travelled_m = here.travelled_m;
  vote.local_T_robot = here.local_T_robot;
  vote.anchor = loop.anchor;
  vote.anchor_T_robot = loop.anchor_T_node;
  vote.ambiguity = loop.ambiguity;
  return consensus_.add(vote, graph);
}

void LoopKeeper::accept(std::size_t index, PoseGraph& graph) {
  LoopRecord& loop = loops_[index];
  loop.verdict = LoopVerdict::kAccepted;
  Constraint constraint;
  constraint.kind = Constraint::Kind::kLoop;
  constraint.from = loop.anchor;
  constraint.to = loop.node;
  constraint.from_T_to = loop.anchor_T_node;
  constraint.information = noisy_information(loop.covariance, options_.loop_sigma_m, options_.loop_sigma_rad);
  loop_of_constraint_.emplace_back(graph.add_constraint(constraint), index);
}

void LoopKeeper::run_last_pass(const PlaceMemory& memory, PoseGraph& graph,
                               const std::function<bool(double)>& progress) {
  std::set<std::pair<std::size_t, std::size_t>> known;
  for (const LoopRecord& loop : loops_)
    if (loop.in_last_pass || loop.verdict != LoopVerdict::kRefused) known.emplace(loop.node, loop.local_map);
  LastPassOutcome outcome = last_pass(
      memory, graph,
      [&](std::size_t node) -> const Matcher& { return policy_.matcher(matcher_of_node_.at(node)); },
      options_.loop_closure.verification, options_.last_pass,
      [&](std::size_t node, std::size_t local_map) {
        return known.count({node, local_map}) > 0;
      },
      options_.seed, pool_, progress);
  for (LoopRecord& loop : outcome.loops) {
    loops_.push_back(std::move(loop));
    if (loops_.back().verdict == LoopVerdict::kAccepted) accept(loops_.size() - 1, graph);
  }
}

void LoopKeeper::settle(PoseGraph& graph, SparsePoseAdjustment& solver) {
  std::vector<std::size_t> constraints;
  for (const auto& of_loop : loop_of_constraint_) constraints.push_back(of_loop.first);
  const std::vector<double> chi =
      switch_off_contradicted_loops(graph, solver, constraints, options_.max_loop_chi);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    LoopRecord& loop = loops_[loop_of_constraint_[i].second];
    loop.reason.clear();
    loop.verdict = LoopVerdict::kAccepted;
    if (graph.enabled(constraints[i])) continue;
    loop.verdict = LoopVerdict::kSwitchedOff;
    loop.reason = contradiction_text(chi[i]);
  }
}

void LoopKeeper::refuse_pending() {
  for (LoopRecord& loop : loops_) {
    if (loop.verdict != LoopVerdict::kPending) continue;
    loop.verdict = LoopVerdict::kRefused;
    loop.reason = kTooFewAgree;
  }
}

std::size_t LoopKeeper::accepted() const {
  return static_cast<std::size_t>(std::count_if(loops_.begin(), loops_.end(), [](const LoopRecord& loop) {
    return loop.verdict == LoopVerdict::kAccepted;
  }));
}

}  // namespace psi_slam
