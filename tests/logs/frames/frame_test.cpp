// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/frame.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace psi_slam {
namespace {

TEST(Frame, each_scan_gets_the_robots_pose_at_its_time) {
  Frame frame;
  frame.companions.resize(1);
  frame.companions[0].scan.laser = 1;
  frame.companions[0].frame_T_robot = {0.1, 0.2, 0.3};
  std::vector<std::pair<std::size_t, mrpt::math::TPose2D>> taken;
  for_each_scan(frame, {3, 4, M_PI / 2}, [&](const LaserScan& scan, const mrpt::math::TPose2D& map_T_robot) {
    taken.emplace_back(scan.laser, map_T_robot);
  });
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].first, 0U);
  EXPECT_EQ(taken[0].second, mrpt::math::TPose2D(3, 4, M_PI / 2));
  EXPECT_EQ(taken[1].first, 1U);
  EXPECT_NEAR(taken[1].second.x, 2.8, 1e-12);
  EXPECT_NEAR(taken[1].second.y, 4.1, 1e-12);
  EXPECT_NEAR(taken[1].second.phi, M_PI / 2 + 0.3, 1e-12);
}

}  // namespace
}  // namespace psi_slam
