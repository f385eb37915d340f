// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace psi_slam {
namespace {

TEST(SimulatedLog, is_reproducible) {
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

TEST(SimulatedLog, further_lasers_scan_with_their_delay_and_change_nothing_else) {
  SimulatedLogOptions options = simulated_log_options(30, 5);
  SimulatedLog alone(options);
  FurtherLaser rear;
  rear.scan.robot_T_laser = {-0.2, 0, M_PI};
  rear.scan.noise_m = 0;
  rear.scan.dropout_share = 0;
  rear.delay_s = 0.05;
  options.further_lasers = {rear};
  SimulatedLog both(options);
  std::optional<Frame> before;
  mrpt::math::TPose2D world_T_before;
  std::size_t turning = 0;
  while (const std::optional<Frame> frame = both.next()) {
    const std::optional<Frame> same = alone.next();
    ASSERT_TRUE(same);
    ASSERT_EQ(frame->odom_T_robot, same->odom_T_robot);
    ASSERT_EQ(frame->time_us, same->time_us);
    ASSERT_EQ(both.world_T_robot(), alone.world_T_robot());
    ASSERT_EQ(frame->companions.size(), 1U);
    if (before) {
      const CompanionScan& scan = before->companions[0];
      EXPECT_EQ(scan.time_us, before->time_us + 50'000);
      EXPECT_EQ(scan.scan.laser, 1U);
      const mrpt::math::TPose2D moved = both.world_T_robot() - world_T_before;
      EXPECT_NEAR(scan.frame_T_robot.phi, 0.4 * moved.phi, 0.02) << "0.05 of 0.125 s";
      turning += std::abs(scan.frame_T_robot.phi) > 0.02 ? 1 : 0;
    }
    before = frame;
    world_T_before = both.world_T_robot();
  }
  EXPECT_FALSE(alone.next());
  EXPECT_GT(turning, 10U);
}

TEST(SimulatedLog, refuses_a_delay_beyond_the_next_scan) {
  SimulatedLogOptions options = simulated_log_options(30, 5);
  options.further_lasers.resize(1);
  options.further_lasers[0].delay_s = 0.125;
  EXPECT_THROW(SimulatedLog{options}, std::invalid_argument);
  options.further_lasers[0].delay_s = -0.01;
  EXPECT_THROW(SimulatedLog{options}, std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
