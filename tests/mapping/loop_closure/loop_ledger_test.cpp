// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_ledger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "pose_graph/graduated_non_convexity.h"

namespace psi_slam {
namespace {

using State = LoopState;
using Reason = LoopRejection::Reason;

constexpr LoopNoise kNoise{0.02, 0.01};

/// Three nodes: node 1 is one metre from node 0, and node 2 is at the place of node 0. True loops connect
/// nodes 0 and 2.
class LoopLedgerTest : public ::testing::Test {
 protected:
  LoopLedgerTest() {
    for (const double x_m : {0.0, 1.0, 0.0}) graph_.add_node({x_m, 0, 0});
    Constraint odometry;
    odometry.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
    odometry.from = 0;
    odometry.to = 1;
    odometry.from_T_to = {1, 0, 0};
    graph_.add_constraint(odometry);
    odometry.from = 1;
    odometry.to = 2;
    odometry.from_T_to = {-1, 0, 0};
    graph_.add_constraint(odometry);
  }

  static LoopRecord loop(State state, double x_m = 0, std::size_t local_map = 0) {
    LoopRecord loop;
    loop.node = 2;
    loop.local_map = local_map;
    loop.anchor = 0;
    loop.anchor_T_node = {x_m, 0, 0};
    loop.reference = 0;
    loop.reference_T_node = loop.anchor_T_node;
    loop.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
    loop.state = state;
    if (state == State::kRejected) reject(loop, {Reason::kLowResponse, 0.41, 0.55});
    return loop;
  }
  static LoopPair pair(std::size_t local_map = 0) { return {2, local_map}; }

  State state(std::size_t loop) const { return ledger_.loops()[loop].state; }
  std::optional<Reason> reason(std::size_t loop) const {
    const LoopRecord& record = ledger_.loops()[loop];
    EXPECT_EQ(record.state == State::kRejected, record.rejection.has_value());
    return record.rejection ? std::optional(record.rejection->reason) : std::nullopt;
  }
  std::size_t loops_in_force() const {
    std::size_t count = 0;
    for (std::size_t i = 2; i < graph_.num_constraints(); ++i) count += graph_.enabled(i);
    return count;
  }

  PoseGraph graph_;
  SparsePoseAdjustment solver_{PoseAdjustmentOptions()};
  LoopLedger ledger_{kNoise};
};

TEST_F(LoopLedgerTest, an_accepted_loop_becomes_a_constraint_once_and_returns_its_residual) {
  const std::size_t number = ledger_.add(loop(State::kAccepted, 0.06));
  EXPECT_NEAR(ledger_.accept(number, graph_).value(), 0.06 / kNoise.sigma_m, 1e-9);
  EXPECT_FALSE(ledger_.accept(number, graph_).has_value());
  ASSERT_EQ(graph_.num_constraints(), 3U);
  EXPECT_EQ(graph_.constraint(2).kind, Constraint::Kind::kLoop);
  EXPECT_NEAR(graph_.constraint(2).information(0, 0), 1 / (1e-4 + 4e-4), 1e-6);
}

TEST_F(LoopLedgerTest, a_constraint_leads_from_the_reference_in_its_axes) {
  LoopRecord turned = loop(State::kAccepted);
  turned.reference = 1;
  turned.anchor_T_node = {5, 6, 0.3};  // the anchor itself does not matter
  turned.reference_T_node = {-1, 0.04, 0.3 + M_PI / 2};
  turned.covariance = Eigen::Vector3d(1e-4, 9e-4, 1e-4).asDiagonal();
  const double chi = ledger_.accept(ledger_.add(turned), graph_).value();
  EXPECT_NEAR(chi, (0.3 + M_PI / 2) / kNoise.sigma_rad, 1e-6) << "residual at the graph's poses";
  const Constraint& constraint = graph_.constraint(2);
  EXPECT_EQ(constraint.from, 1U);
  EXPECT_EQ(constraint.to, 2U);
  EXPECT_EQ(constraint.from_T_to, turned.reference_T_node);
  EXPECT_NEAR(constraint.information(0, 0), 1 / (9e-4 + 4e-4), 1e-6);
  EXPECT_NEAR(constraint.information(1, 1), 1 / (1e-4 + 4e-4), 1e-6);
}

TEST_F(LoopLedgerTest, a_rejected_loop_becomes_no_constraint) {
  EXPECT_FALSE(ledger_.accept(ledger_.add(loop(State::kRejected)), graph_).has_value());
  EXPECT_EQ(graph_.num_constraints(), 2U);
}

TEST_F(LoopLedgerTest, candidates_are_rejected_at_the_end) {
  const std::size_t waits = ledger_.add(loop(State::kCandidate));
  const std::size_t accepted = ledger_.add(loop(State::kAccepted, 0, 1));
  ledger_.reject_candidates();
  EXPECT_EQ(reason(waits), Reason::kNoConsensus);
  EXPECT_EQ(state(accepted), State::kAccepted);
}

TEST_F(LoopLedgerTest, an_outlier_loop_is_rejected_unless_forced) {
  const std::size_t wrong = ledger_.add(loop(State::kAccepted, 3));
  ledger_.accept(wrong, graph_);
  ledger_.settle(graph_, solver_);
  EXPECT_EQ(reason(wrong), Reason::kContradicted);
  EXPECT_EQ(loops_in_force(), 0U);
  EXPECT_TRUE(ledger_.force(pair(), false, graph_));
  ledger_.settle(graph_, solver_);
  EXPECT_EQ(state(wrong), State::kAccepted);
  EXPECT_EQ(loops_in_force(), 1U);
}

TEST_F(LoopLedgerTest, an_outlier_loop_states_its_residual_and_the_limit) {
  const std::size_t wrong = ledger_.add(loop(State::kAccepted, 3));
  ledger_.accept(wrong, graph_);
  ledger_.settle(graph_, solver_);
  const std::optional<LoopRejection>& rejection = ledger_.loops()[wrong].rejection;
  ASSERT_TRUE(rejection);
  EXPECT_EQ(rejection->reason, Reason::kContradicted);
  EXPECT_NEAR(rejection->value, 3 / std::sqrt(1e-4 + 4e-4), 0.1);
  EXPECT_EQ(rejection->limit, kInlierChi);
}

TEST_F(LoopLedgerTest, a_force_that_path_and_loops_contradict_is_listed) {
  EXPECT_TRUE(ledger_.contradicted_forces(graph_, solver_).empty());
  const std::size_t right = ledger_.add(loop(State::kAccepted, 0.01, 0));
  ledger_.accept(right, graph_);
  ledger_.add(loop(State::kRejected, 3, 2));
  ledger_.add(loop(State::kRejected, 0.02, 1));
  EXPECT_TRUE(ledger_.force(pair(2), false, graph_));
  EXPECT_TRUE(ledger_.force(pair(1), false, graph_));
  ledger_.settle(graph_, solver_);
  EXPECT_EQ(reason(right), Reason::kContradicted) << "an unforced loop yields to a forced one";

  const std::vector<LoopLedger::ContradictedForce> contradicted =
      ledger_.contradicted_forces(graph_, solver_);
  ASSERT_EQ(contradicted.size(), 2U) << "the forced loops contradict each other";
  EXPECT_EQ(contradicted[0].pair, pair(1));
  EXPECT_EQ(contradicted[1].pair, pair(2));
  // The rest places node 2 at 0.01 m, and is at most as uncertain as the path.
  const double loop_m2 = 1e-4 + kNoise.sigma_m * kNoise.sigma_m;
  EXPECT_GT(contradicted[1].chi, 2.98 / std::sqrt(loop_m2 + 2e-4));
  EXPECT_LT(contradicted[1].chi, 3 / std::sqrt(loop_m2));
  EXPECT_LT(contradicted[0].chi, contradicted[1].chi) << "path and loop agree with this one";

  ASSERT_TRUE(ledger_.restore(pair(2), graph_));
  ledger_.settle(graph_, solver_);
  EXPECT_TRUE(ledger_.contradicted_forces(graph_, solver_).empty())
      << "the other force agrees with path and loop";
  EXPECT_EQ(state(right), State::kAccepted);
}

TEST_F(LoopLedgerTest, a_forced_constraint_loses_its_kernel_until_restored) {
  const std::size_t number = ledger_.add(loop(State::kAccepted, 3));
  ledger_.accept(number, graph_);
  ledger_.settle(graph_, solver_);
  ASSERT_EQ(reason(number), Reason::kContradicted);
  EXPECT_FALSE(graph_.constraint(2).kernel) << "the solver's kernel for loops";

  EXPECT_TRUE(ledger_.force(pair(), false, graph_));
  EXPECT_EQ(state(number), State::kAccepted);
  EXPECT_TRUE(ledger_.loops()[number].by_hand);
  EXPECT_FALSE(ledger_.loops()[number].rejection);
  ASSERT_EQ(graph_.num_constraints(), 4U) << "the forced loop has a constraint of its own";
  EXPECT_FALSE(graph_.enabled(2));
  EXPECT_TRUE(graph_.enabled(3));
  ASSERT_TRUE(graph_.constraint(3).kernel);
  EXPECT_EQ(graph_.constraint(3).kernel->type, RobustKernel::Type::kNone);
  EXPECT_EQ(graph_.constraint(3).from_T_to, graph_.constraint(2).from_T_to);

  EXPECT_TRUE(ledger_.restore(pair(), graph_));
  EXPECT_EQ(reason(number), Reason::kContradicted);
  EXPECT_FALSE(ledger_.loops()[number].by_hand);
  EXPECT_EQ(loops_in_force(), 0U);
  ledger_.settle(graph_, solver_);
  EXPECT_EQ(reason(number), Reason::kContradicted);
  EXPECT_EQ(loops_in_force(), 0U);
}

TEST_F(LoopLedgerTest, an_accepted_loop_that_was_forced_is_accepted_again_when_restored) {
  const std::size_t number = ledger_.add(loop(State::kAccepted, 0.01));
  ledger_.accept(number, graph_);
  EXPECT_TRUE(ledger_.force(pair(), false, graph_));
  EXPECT_TRUE(ledger_.force(pair(), false, graph_)) << "forced twice";
  EXPECT_EQ(loops_in_force(), 1U);
  EXPECT_TRUE(ledger_.restore(pair(), graph_));
  EXPECT_EQ(state(number), State::kAccepted);
  EXPECT_EQ(loops_in_force(), 1U);
  EXPECT_TRUE(graph_.enabled(2)) << "its first constraint";
  ledger_.remove(pair(), graph_);
  EXPECT_EQ(loops_in_force(), 0U);
}

TEST_F(LoopLedgerTest, a_deleted_loop_is_disabled_until_restored) {
  const std::size_t number = ledger_.add(loop(State::kAccepted));
  ledger_.accept(number, graph_);
  ledger_.remove(pair(), graph_);
  EXPECT_EQ(reason(number), Reason::kDeletedByHand);
  EXPECT_EQ(loops_in_force(), 0U);
  EXPECT_TRUE(ledger_.restore(pair(), graph_));
  EXPECT_EQ(state(number), State::kAccepted);
  EXPECT_FALSE(ledger_.loops()[number].by_hand);
  EXPECT_EQ(loops_in_force(), 1U);
  EXPECT_EQ(graph_.num_constraints(), 3U) << "the loop keeps its constraint";
  EXPECT_FALSE(ledger_.restore(pair(), graph_));
}

TEST_F(LoopLedgerTest, a_force_of_the_final_search_leaves_an_earlier_match_to_the_graph) {
  const std::size_t wrong = ledger_.add(loop(State::kAccepted, 3));
  ledger_.accept(wrong, graph_);
  EXPECT_FALSE(ledger_.force(pair(), true, graph_)) << "the final search has found no match yet";
  ledger_.settle(graph_, solver_);
  EXPECT_EQ(reason(wrong), Reason::kContradicted);
  EXPECT_FALSE(graph_.enabled(2));
}

TEST_F(LoopLedgerTest, edits_hold_for_later_matches) {
  ledger_.remove(pair(0), graph_);
  EXPECT_FALSE(ledger_.force(pair(1), false, graph_)) << "no match exists yet";
  EXPECT_EQ(ledger_.forced_in_vain(), std::vector<LoopPair>{pair(1)});
  EXPECT_EQ(reason(ledger_.add(loop(State::kAccepted, 0, 0))), Reason::kDeletedByHand);
  EXPECT_EQ(state(ledger_.add(loop(State::kRejected, 0, 1))), State::kAccepted);
  EXPECT_TRUE(ledger_.forced_in_vain().empty());
  EXPECT_TRUE(ledger_.restore(pair(1), graph_));
  EXPECT_EQ(ledger_.find(pair(1))->state, State::kRejected) << "without a force, its own state counts again";
}

TEST_F(LoopLedgerTest, a_match_by_hand_replaces_earlier_attempts) {
  const std::size_t number = ledger_.add(loop(State::kAccepted, 0.5));
  ledger_.accept(number, graph_);
  ledger_.replace(loop(State::kAccepted, 0.1), graph_);
  ASSERT_EQ(ledger_.loops().size(), 1U);
  EXPECT_EQ(ledger_.find(pair())->anchor_T_node.x, 0.1);
  EXPECT_EQ(loops_in_force(), 1U);
  ledger_.restore(pair(), graph_);
  EXPECT_EQ(ledger_.find(pair())->anchor_T_node.x, 0.5);
  EXPECT_EQ(loops_in_force(), 1U);
}

TEST_F(LoopLedgerTest, the_final_search_leaves_out_decided_pairs) {
  ledger_.add(loop(State::kRejected, 0, 0));
  ledger_.add(loop(State::kAccepted, 0, 1));
  LoopRecord nothing = loop(State::kRejected, 0, 2);
  nothing.rejection->reason = Reason::kNothingFound;
  ledger_.add(nothing);
  LoopRecord searched = loop(State::kRejected, 0, 3);
  searched.in_final_search = true;
  ledger_.add(searched);
  ledger_.add(loop(State::kRejected, 0, 4));
  ledger_.remove(pair(4), graph_);
  EXPECT_EQ(ledger_.searched_pairs(), (std::set<LoopPair>{pair(1), pair(3), pair(4)}));
}

}  // namespace
}  // namespace psi_slam
