// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_ledger.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/graduated_non_convexity.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

LoopPair pair_of(const LoopRecord& loop) {
  return {loop.node, loop.local_map};
}

void delete_by_hand(LoopRecord& loop, LoopRejection::Reason reason) {
  reject(loop, {reason});
  loop.by_hand = true;
}

void accept_by_hand(LoopRecord& loop) {
  loop.state = LoopState::kAccepted;
  loop.rejection.reset();
  loop.by_hand = true;
}

}  // namespace

std::size_t LoopLedger::add(LoopRecord loop) {
  const auto wanted = by_hand_.find(pair_of(loop));
  if (wanted != by_hand_.end()) {
    wanted->second.before.push_back({loops_.size(), loop, std::nullopt});
    if (wanted->second.kind == LoopEdit::Kind::kDelete)
      delete_by_hand(loop, LoopRejection::Reason::kDeletedByHand);
    else if (wanted->second.kind == LoopEdit::Kind::kForce && !found_nothing(loop) &&
             (!wanted->second.of_final_search || loop.in_final_search))
      accept_by_hand(loop);
  }
  return enter(std::move(loop));
}

std::size_t LoopLedger::enter(LoopRecord loop) {
  loops_.push_back(std::move(loop));
  constraint_of_.emplace_back();
  return loops_.size() - 1;
}

std::optional<double> LoopLedger::accept(std::size_t index, PoseGraph& graph) {
  LoopRecord& loop = loops_.at(index);
  if (loop.state == LoopState::kRejected || constraint_of_[index]) return std::nullopt;
  loop.state = LoopState::kAccepted;
  add_constraint(index, graph);
  const mrpt::math::TPose2D off =
      between(between(graph.pose(loop.reference), graph.pose(loop.node)), loop.reference_T_node);
  return std::max(portable::hypot(off.x, off.y) / noise_.sigma_m, std::abs(off.phi) / noise_.sigma_rad);
}

// Adds the constraint of a loop. A forced loop has no robust kernel, so it holds whatever contradicts it.
void LoopLedger::add_constraint(std::size_t index, PoseGraph& graph) {
  const LoopRecord& loop = loops_[index];
  Constraint constraint;
  constraint.from = loop.reference;
  constraint.to = loop.node;
  constraint.from_T_to = loop.reference_T_node;
  constraint.information =
      noisy_information(in_turned_axes(loop.covariance, loop.reference_T_node.phi - loop.anchor_T_node.phi),
                        noise_.sigma_m, noise_.sigma_rad);
  constraint.kind = Constraint::Kind::kLoop;
  if (is_forced(index)) constraint.kernel = RobustKernel{};
  link(index, graph.add_constraint(constraint));
}

bool LoopLedger::is_forced(std::size_t loop) const {
  const auto wanted = by_hand_.find(pair_of(loops_[loop]));
  return wanted != by_hand_.end() && wanted->second.kind == LoopEdit::Kind::kForce &&
         (!wanted->second.of_final_search || loops_[loop].in_final_search);
}

std::pair<std::vector<std::size_t>, std::vector<std::size_t>> LoopLedger::unforced() const {
  std::pair<std::vector<std::size_t>, std::vector<std::size_t>> unforced;
  for (const auto& [constraint, loop] : constraints_) {
    if (is_forced(loop)) continue;
    unforced.first.push_back(constraint);
    unforced.second.push_back(loop);
  }
  return unforced;
}

void LoopLedger::settle(PoseGraph& graph, SparsePoseAdjustment& solver) {
  const auto [constraints, loops] = unforced();
  const std::vector<double> chi = reject_outlier_loops(graph, solver, constraints);
  for (std::size_t i = 0; i < chi.size(); ++i) {
    LoopRecord& loop = loops_[loops[i]];
    loop.state = LoopState::kAccepted;
    loop.rejection.reset();
    if (!graph.enabled(constraints[i]))
      reject(loop, {LoopRejection::Reason::kContradicted, chi[i], kInlierChi});
  }
}

std::vector<LoopLedger::ContradictedForce> LoopLedger::contradicted_forces(
    const PoseGraph& graph, SparsePoseAdjustment& solver) const {
  std::vector<ContradictedForce> contradicted;
  const std::vector<std::size_t> others = unforced().first;
  for (const auto& [constraint, loop] : constraints_) {
    if (!is_forced(loop)) continue;
    PoseGraph rest = graph;
    rest.set_enabled(constraint, false);
    reject_outlier_loops(rest, solver, others);
    const std::optional<double> chi = contradiction(graph.constraint(constraint), rest);
    if (chi.value_or(0) > kInlierChi) contradicted.push_back({pair_of(loops_[loop]), *chi});
  }
  std::sort(contradicted.begin(), contradicted.end(),
            [](const ContradictedForce& a, const ContradictedForce& b) { return a.pair < b.pair; });
  return contradicted;
}

void LoopLedger::reject_candidates() {
  for (LoopRecord& loop : loops_)
    if (loop.state == LoopState::kCandidate) reject(loop, {LoopRejection::Reason::kNoConsensus});
}

std::set<LoopPair> LoopLedger::searched_pairs() const {
  std::set<LoopPair> pairs;
  for (const LoopRecord& loop : loops_) {
    const bool failed = loop.state == LoopState::kRejected && !is_outlier(loop);
    if (!failed || loop.in_final_search || loop.by_hand) pairs.insert(pair_of(loop));
  }
  return pairs;
}

void LoopLedger::remove(const LoopPair& pair, PoseGraph& graph) {
  take_over(pair, LoopEdit::Kind::kDelete, graph);
  for (const std::size_t loop : attempts_of(pair)) strike(loop, LoopRejection::Reason::kDeletedByHand, graph);
}

bool LoopLedger::force(const LoopPair& pair, bool of_final_search, PoseGraph& graph) {
  take_over(pair, LoopEdit::Kind::kForce, graph);
  by_hand_[pair].of_final_search = of_final_search;
  const std::vector<std::size_t> attempts = attempts_of(pair);
  const auto found = std::find_if(attempts.rbegin(), attempts.rend(), [&](std::size_t loop) {
    return !found_nothing(loops_[loop]) && (!of_final_search || loops_[loop].in_final_search);
  });
  if (found == attempts.rend()) return false;
  for (const std::size_t other : attempts)
    if (other != *found) strike(other, LoopRejection::Reason::kOtherMatchForced, graph);
  if (constraint_of_[*found]) strike(*found, LoopRejection::Reason::kMatchedAgain, graph);
  accept_by_hand(loops_[*found]);
  accept(*found, graph);
  return true;
}

std::vector<LoopPair> LoopLedger::forced_in_vain() const {
  std::vector<LoopPair> pairs;
  for (const auto& [pair, by_hand] : by_hand_) {
    if (by_hand.kind != LoopEdit::Kind::kForce) continue;
    const std::vector<std::size_t> attempts = attempts_of(pair);
    if (std::none_of(attempts.begin(), attempts.end(),
                     [&](std::size_t loop) { return loops_[loop].state == LoopState::kAccepted; }))
      pairs.push_back(pair);
  }
  return pairs;
}

void LoopLedger::replace(LoopRecord loop, PoseGraph& graph) {
  const LoopPair pair = pair_of(loop);
  take_over(pair, LoopEdit::Kind::kMatch, graph);
  const std::vector<std::size_t> attempts = attempts_of(pair);
  for (const std::size_t before : attempts) strike(before, LoopRejection::Reason::kMatchedAgain, graph);
  loop.by_hand = true;
  const bool accepted = loop.state == LoopState::kAccepted;
  const std::size_t index = attempts.empty() ? enter(loop) : attempts.back();
  loops_[index] = std::move(loop);
  if (accepted) accept(index, graph);
}

bool LoopLedger::restore(const LoopPair& pair, PoseGraph& graph) {
  const auto wanted = by_hand_.find(pair);
  if (wanted == by_hand_.end()) return false;
  for (const std::size_t loop : attempts_of(pair)) {
    strike(loop, LoopRejection::Reason::kMatchTakenBack, graph);
    loops_[loop].by_hand = false;
  }
  for (const Entry& entry : wanted->second.before) {
    loops_[entry.loop] = entry.record;
    if (entry.constraint) {
      link(entry.loop, *entry.constraint);
      graph.set_enabled(*entry.constraint, entry.record.state == LoopState::kAccepted);
    } else if (entry.record.state == LoopState::kAccepted) {
      accept(entry.loop, graph);
    }
  }
  by_hand_.erase(wanted);
  return true;
}

const LoopRecord* LoopLedger::find(const LoopPair& pair) const {
  const std::vector<std::size_t> attempts = attempts_of(pair);
  return attempts.empty() ? nullptr : &loops_[attempts.back()];
}

std::vector<std::size_t> LoopLedger::attempts_of(const LoopPair& pair) const {
  std::vector<std::size_t> attempts;
  for (std::size_t loop = 0; loop < loops_.size(); ++loop)
    if (pair_of(loops_[loop]) == pair) attempts.push_back(loop);
  return attempts;
}

void LoopLedger::take_over(const LoopPair& pair, LoopEdit::Kind kind, PoseGraph& graph) {
  restore(pair, graph);
  ByHand& by_hand = by_hand_[pair];
  by_hand.kind = kind;
  for (const std::size_t loop : attempts_of(pair))
    by_hand.before.push_back({loop, loops_[loop], constraint_of_[loop]});
}

void LoopLedger::link(std::size_t loop, std::size_t constraint) {
  constraint_of_[loop] = constraint;
  constraints_.emplace_back(constraint, loop);
}

void LoopLedger::strike(std::size_t loop, LoopRejection::Reason reason, PoseGraph& graph) {
  if (const auto constraint = std::exchange(constraint_of_[loop], std::nullopt)) {
    graph.set_enabled(*constraint, false);
    constraints_.erase(std::find(constraints_.begin(), constraints_.end(), std::pair(*constraint, loop)));
  }
  delete_by_hand(loops_[loop], reason);
}

}  // namespace psi_slam
