// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/wall_direction.h"

#include <gtest/gtest.h>

#include <utility>

#include "simulated_room.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Direction of the walls if the map's frame is turned by `turn_rad` against the room.
double direction_rad(double turn_rad) {
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  std::vector<Frame> log;
  std::vector<TPose2D> poses;
  for (int i = 0; i < 8; ++i) {
    const TPose2D room_T_robot(0.2 * i, 0.1 * i, 0.7 * i);
    log.push_back(SimulatedRoom().scan_from(room_T_robot, bearings));
    poses.push_back(TPose2D(3, -2, turn_rad) + room_T_robot);
  }
  return wall_direction_rad(log, poses);
}

TEST(WallDirection, is_found_to_a_tenth_of_a_degree_modulo_90_degrees) {
  const double tolerance_rad = 0.0018;
  for (const double degrees : {0.0, 10.3, 44.0, -44.0, -0.1})
    EXPECT_NEAR(direction_rad(degrees * M_PI / 180), degrees * M_PI / 180, tolerance_rad) << degrees;
  EXPECT_NEAR(direction_rad(100 * M_PI / 180), 10 * M_PI / 180, tolerance_rad);
  EXPECT_NEAR(std::abs(direction_rad(M_PI / 4)), M_PI / 4, tolerance_rad);
}

TEST(WallDirection, uses_the_scans_of_all_lasers) {
  Frame frame = SimulatedRoom().scan_from({1, 0.5, 0.3}, even_bearings(-M_PI / 2, M_PI / 2, 181));
  const double expected_rad = wall_direction_rad({frame}, {{0, 0, 0.3}});
  frame.companions = {{std::exchange(frame.scan, {}), frame.time_us, {0, 0, 0.2}}};
  EXPECT_NEAR(wall_direction_rad({frame}, {{0, 0, 0.1}}), expected_rad, 1e-9);
  EXPECT_NEAR(expected_rad, 0, 0.01);
}

TEST(WallDirection, is_0_without_walls) {
  EXPECT_EQ(wall_direction_rad({}, {}), 0);
  EXPECT_EQ(wall_direction_rad({Frame()}, {{0, 0, 1}}), 0);
}

}  // namespace
}  // namespace psi_slam
