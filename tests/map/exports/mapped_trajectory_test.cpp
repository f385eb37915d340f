// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/mapped_trajectory.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(MappedTrajectory, has_the_mapped_pose_of_each_frame_in_order) {
  std::vector<FrameRecord> frames(2);
  frames[0].time_us = 2'000'000;  // times may decrease
  frames[0].map_T_robot = {1, 2, 0.3};
  frames[0].front_end_T_robot = {9, 9, 0.9};
  frames[1].time_us = 1'000'000;
  frames[1].map_T_robot = {4, 5, -0.6};
  const Trajectory trajectory = trajectory_of(frames);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].time_us, 2'000'000);
  EXPECT_EQ(trajectory[0].pose, mrpt::math::TPose2D(1, 2, 0.3));
  EXPECT_EQ(trajectory[1].time_us, 1'000'000);
  EXPECT_EQ(trajectory[1].pose, mrpt::math::TPose2D(4, 5, -0.6));
}

}  // namespace
}  // namespace psi_slam
