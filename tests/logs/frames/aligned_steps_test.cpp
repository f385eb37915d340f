// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/aligned_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "frames_in_memory.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

std::vector<Frame> frames_of(const SimulatedRun& run) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    Frame frame;
    frame.index = i;
    frame.odom_T_robot = run.odometry[i];
    frame.scan = run.scan(i);
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST(AlignedSteps, join_and_show_the_true_motion) {
  const SimulatedRun run = simulated_run({{0.08, 0, 20}, {0, 4, 20}});
  FramesInMemory log(frames_of(run));
  AlignedSteps steps(log, 0.2, 0.2);
  mrpt::math::TPose2D by_scans{0, 0, 0};
  mrpt::math::TPose2D by_odometry{0, 0, 0};
  std::size_t count = 0;
  for (; const auto step = steps.next(); ++count) {
    EXPECT_TRUE(step->by_odometry.norm() >= 0.2 || std::abs(step->by_odometry.phi) >= 0.2);
    EXPECT_TRUE(step->by_scans.is_reliable());
    EXPECT_LT(step->difference().norm(), 0.03);
    by_scans = compose(by_scans, step->by_scans.reference_T_scan);
    by_odometry = compose(by_odometry, step->by_odometry);
  }
  EXPECT_GE(count, 10U);
  const mrpt::math::TPose2D truth = between(run.truth.front(), run.truth.back());
  EXPECT_LT(distance_m(by_scans, truth), 0.15);
  EXPECT_LT(distance_m(by_odometry, truth), 0.25);
}

TEST(AlignedSteps, end_at_a_scan_without_odometry) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.08, 0, 40}}));
  frames[10].has_odometry = false;
  FramesInMemory log(std::move(frames));
  AlignedSteps steps(log, 0.3, 0.2);
  std::size_t count = 0;
  while (steps.next()) ++count;
  EXPECT_LE(count, 3U);
  EXPECT_GE(count, 2U);
}

}  // namespace
}  // namespace psi_slam
