// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/simulation/simulated_log.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

TEST(SimulatedLog, is_the_same_twice) {
  SimulatedLogOptions options = simulated_log_options(60, 5);
  options.people = 4;
  SimulatedLog first(options);
  SimulatedLog second(options);
  std::size_t frames = 0;
  while (const std::optional<Frame> one = first.next()) {
    const std::optional<Frame> other = second.next();
    ASSERT_TRUE(other);
    ASSERT_EQ(one->index, frames++);
    ASSERT_EQ(one->time_us, other->time_us);
    ASSERT_EQ(one->odom_T_robot, other->odom_T_robot);
    ASSERT_EQ(first.world_T_robot(), second.world_T_robot());
    for (std::size_t i = 0; i < one->scan.ranges_m.size(); ++i)
      ASSERT_TRUE(one->scan.ranges_m[i] == other->scan.ranges_m[i] ||
                  (std::isnan(one->scan.ranges_m[i]) && std::isnan(other->scan.ranges_m[i])));
  }
  EXPECT_FALSE(second.next());
  EXPECT_GT(frames, 400U);
  EXPECT_EQ(first.progress(), 1);
}

TEST(SimulatedLog, differs_by_seed) {
  SimulatedLog first(simulated_log_options(60, 5));
  SimulatedLog second(simulated_log_options(60, 6));
  EXPECT_NE(first.next()->scan.ranges_m, second.next()->scan.ranges_m);
}

TEST(SimulatedLog, odometry_starts_at_the_origin_and_follows_the_truth) {
  SimulatedLog log(simulated_log_options(60, 5));
  EXPECT_EQ(log.next()->odom_T_robot, mrpt::math::TPose2D(0, 0, 0));
  const mrpt::math::TPose2D start = log.world_T_robot();
  mrpt::math::TPose2D odometry;
  while (log.travelled_m() < 3) odometry = log.next()->odom_T_robot;
  const mrpt::math::TPose2D truth = log.world_T_robot() - start;
  EXPECT_NEAR(odometry.x, truth.x, 0.3);
  EXPECT_NEAR(odometry.y, truth.y, 0.3);
}

}  // namespace
}  // namespace psi_slam
