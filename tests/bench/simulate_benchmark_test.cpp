// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulate_benchmark.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

SimulateRow map(double path_m, std::size_t people, double glass_share, std::uint64_t seed = 1) {
  SimulateOptions options;
  options.seed = seed;
  options.people = people;
  options.glass_share = glass_share;
  return map_simulated_run(simulated_run_options(options, path_m), 1, [](double) {});
}

TEST(SimulateBenchmark, maps_a_small_building_close_to_the_truth) {
  const SimulateRow row = map(150, 0, 0);
  EXPECT_LT(row.error_mean_m, 0.15);
  EXPECT_LT(row.error_mean_m, row.odometry_error_mean_m / 3);
  EXPECT_GT(row.loops, 100U);
  EXPECT_EQ(row.false_loops, 0U);
}

TEST(SimulateBenchmark, maps_with_glass_and_people) {
  const SimulateRow row = map(150, 30, 0.3);
  EXPECT_LT(row.error_mean_m, 0.25);
  EXPECT_EQ(row.false_loops, 0U);
}

TEST(SimulateBenchmark, other_buildings_are_mapped_as_well) {
  for (const std::uint64_t seed : {2U, 3U, 4U, 5U}) {
    const SimulateRow row = map(80, 30, 0.2, seed);
    EXPECT_LT(row.error_mean_m, 0.2) << "seed " << seed;
    EXPECT_LT(row.error_mean_m, row.odometry_error_mean_m / 5) << "seed " << seed;
    EXPECT_GT(row.loops, 100U) << "seed " << seed;
    EXPECT_EQ(row.false_loops, 0U) << "seed " << seed;
  }
}

TEST(SimulateBenchmark, p99_is_the_least_value_that_99_of_100_do_not_exceed) {
  std::vector<double> values;
  EXPECT_EQ(summary_of_times(values).p99, 0);
  const auto add_up_to = [&](std::size_t count) {
    while (values.size() < count) values.insert(values.begin(), static_cast<double>(values.size() + 1));
    return summary_of_times(values).p99;
  };
  EXPECT_EQ(add_up_to(1), 1);
  EXPECT_EQ(add_up_to(2), 2);
  EXPECT_EQ(add_up_to(99), 99);
  EXPECT_EQ(add_up_to(100), 99);
  EXPECT_EQ(summary_of_times(values).mean, 50.5);
  EXPECT_EQ(summary_of_times(values).max, 100);
  EXPECT_EQ(add_up_to(101), 100);
  EXPECT_EQ(add_up_to(200), 198);
}

TEST(SimulateBenchmark, errors_are_distances_after_alignment_at_the_start) {
  const Trajectory truth = {{0, {5, 5, M_PI / 2}}, {1, {5, 7, M_PI / 2}}};
  EXPECT_NEAR(trajectory_error_m({{0, 0, 0}, {2, 0, 0}}, truth).max, 0, 1e-12);
  EXPECT_NEAR(trajectory_error_m({{0, 0, 0}, {2, 0.5, 0}}, truth).max, 0.5, 1e-12);
}

TEST(SimulateBenchmark, false_loops_contradict_the_truth) {
  const Trajectory truth = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {2, 0, 3}}};
  MappingResult result;
  result.node_frames = {0, 2};
  LoopRecord loop;
  loop.state = LoopState::kAccepted;
  loop.frame = 2;
  loop.node = 1;
  loop.anchor = 0;
  for (const TPose2D& found : {TPose2D(2.4, 0, 3), TPose2D(2.6, 0, 3), TPose2D(2, 0, 3.08 - 2 * M_PI),
                               TPose2D(2, 0, 3.1 - 2 * M_PI)}) {
    loop.anchor_T_node = found;
    result.loops.push_back(loop);
  }
  EXPECT_EQ(count_false_loops(result, truth), 2U);
  for (LoopRecord& record : result.loops) reject(record, {LoopRejection::Reason::kContradicted});
  EXPECT_EQ(count_false_loops(result, truth), 0U);
}

TEST(SimulateBenchmark, relations_are_true_and_seeded) {
  Trajectory truth;
  for (int i = 0; i < 100; ++i) truth.push_back({i * 100'000, {0.1 * i, 0.01 * i, 0.02 * i}});
  const std::vector<Relation> relations = draw_relations(truth, 50, 1);
  EXPECT_LT(evaluate_relations(truth, relations).translation_abs_m.max, 1e-9);
  EXPECT_EQ(relations[7].time1_us, draw_relations(truth, 50, 1)[7].time1_us);
  EXPECT_NE(relations[7].pose1_T_pose2, draw_relations(truth, 50, 2)[7].pose1_T_pose2);
}

}  // namespace
}  // namespace psi_slam
