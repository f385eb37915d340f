// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/scan_delay.h"

#include <gtest/gtest.h>

#include "aligned_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::optional<ScanDelay> delay_of(const SimulatedRun& run) {
  const AlignedRun aligned = aligned_run(run);
  return estimate_scan_delay(aligned.marks, reliable_turns(aligned.pairs));
}

/// A run with many short turns to both sides.
SimulatedRun weaving_run(unsigned seed) {
  const std::vector<RunPart> weave{{0.05, 6, 6}, {0.05, 0, 7}, {0.05, -6, 12}, {0.05, 1, 5}, {0.05, 6, 6}};
  std::vector<RunPart> parts;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < 3; ++i) parts.insert(parts.end(), weave.begin(), weave.end());
    parts.push_back({0, 9, 20});
  }
  SimulatedRun run = simulated_run(parts, {2, 1.8, 0}, seed);
  run.seed = seed;
  return run;
}

TEST(ScanDelay, errors_are_as_large_as_the_standard_deviation) {
  constexpr unsigned kRuns = 12;
  double squares = 0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const double delay_s = 0.1 * (seed % 5) - 0.15;
    const auto found = delay_of(with_late_stamps(weaving_run(seed), delay_s));
    ASSERT_TRUE(found) << delay_s;
    EXPECT_LT(found->deviation_s, 0.02);
    EXPECT_NEAR(found->delay_s, delay_s, 0.03);
    squares += std::pow((found->delay_s - delay_s) / found->deviation_s, 2);
  }
  EXPECT_GT(std::sqrt(squares / kRuns), 0.4);
  EXPECT_LT(std::sqrt(squares / kRuns), 1.8);
}

TEST(ScanDelay, wrong_turns_of_odometry_do_not_disturb) {
  SimulatedRun run = weaving_run(1);
  const std::vector<TPose2D> odometry = run.odometry;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    TPose2D step = odometry[i] - odometry[i - 1];
    step.phi *= 1.05;
    run.odometry[i] = run.odometry[i - 1] + step;
  }
  const auto found = delay_of(with_late_stamps(run, 0.25));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->is_significant());
  EXPECT_NEAR(found->delay_s, 0.25, 4 * found->deviation_s);
}

TEST(ScanDelay, straight_motion_shows_no_delay) {
  const auto found = delay_of(with_late_stamps(simulated_run({{0.08, 0, 115}, {-0.08, 0, 115}}), 0.2));
  EXPECT_FALSE(found && found->is_significant());
}

TEST(ScanDelay, shifts_the_odometry_of_marks) {
  const std::vector<FrameMark> marks{{0, {0, 0, 0}}, {100'000, {1, 0, 0.1}}, {200'000, {3, 0, 0.2}}};
  const std::vector<FrameMark> shifted = with_scan_delay(marks, 0.05);
  EXPECT_EQ(shifted[0].odom_T_robot, TPose2D(0, 0, 0));
  EXPECT_DOUBLE_EQ(shifted[1].odom_T_robot.x, 0.5);
  EXPECT_DOUBLE_EQ(shifted[2].odom_T_robot.x, 2);
  EXPECT_DOUBLE_EQ(shifted[2].odom_T_robot.phi, 0.15);
  EXPECT_EQ(shifted[2].time_us, 200'000);
}

}  // namespace
}  // namespace psi_slam
