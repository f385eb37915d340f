// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/open_directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "map/verdict/map_views.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

/// A laser in the middle of a corridor along x, with walls beyond its range at both ends.
struct Corridor {
  double width_m = 2;
  double range_m = 8;
  double noise_m = 0;
  int beams = 361;
  double field_of_view_rad = M_PI;
  double end_m = 1000;  ///< distance of the wall ahead
};

/// Scans from places 0.25 m apart along the corridor. The wall ahead moves with the robot.
MappingResult drive(const Corridor& corridor, double heading_rad, int scans, bool has_odometry = true) {
  SimulatedRoom room;
  room.x_min = -1000;
  room.y_min = -corridor.width_m / 2;
  room.y_max = corridor.width_m / 2;
  const BeamBearings bearings =
      even_bearings(-corridor.field_of_view_rad / 2, corridor.field_of_view_rad / 2, corridor.beams);
  std::mt19937 generator(1);
  std::normal_distribution<double> noise_m(0, corridor.noise_m + 1e-12);
  MappingResult result;
  for (int i = 0; i < scans; ++i) {
    const mrpt::math::TPose2D pose(0.25 * i, 0.1, heading_rad);
    room.x_max = pose.x + corridor.end_m;
    Frame frame = room.scan_from(pose, bearings);
    frame.has_odometry = has_odometry;
    for (float& range_m : frame.scan.ranges_m)
      range_m = range_m < static_cast<float>(corridor.range_m)
                    ? range_m + static_cast<float>(noise_m(generator))
                    : std::numeric_limits<float>::infinity();
    FrameRecord record;
    record.map_T_robot = pose;
    record.node = result.node_frames.size();
    result.node_frames.push_back(static_cast<std::size_t>(i));
    result.frames.push_back(record);
    result.log.push_back(std::move(frame));
  }
  return result;
}

TEST(OpenDirections, are_along_bare_corridors_of_any_width_and_laser) {
  for (const double width_m : {1.2, 2.0, 4.0})
    for (const double range_m : {4.0, 8.0, 30.0})
      for (const double noise_m : {0.0, 0.005, 0.01})
        for (const int beams : {181, 361, 1081})
          for (const double heading_rad : {0.0, 0.7, M_PI / 2}) {
            Corridor corridor{width_m, range_m, noise_m, beams, 1.5 * M_PI};
            const std::optional<MapView> view = view_of_frame(drive(corridor, heading_rad, 1), 0);
            ASSERT_TRUE(view && view->open_direction)
                << width_m << " m wide, range " << range_m << " m, noise " << noise_m << " m, " << beams
                << " beams, heading " << heading_rad;
            // Unit vector along x in the frame of the robot.
            EXPECT_GT(std::abs(view->open_direction->x * std::cos(heading_rad) -
                               view->open_direction->y * std::sin(heading_rad)),
                      0.99);
          }
}

TEST(OpenDirections, are_closed_by_a_wall_across_the_corridor) {
  for (const double width_m : {1.2, 2.0, 4.0})
    for (const double noise_m : {0.0, 0.01, 0.02}) {
      Corridor corridor{width_m, 8, noise_m};
      corridor.end_m = 4;
      const std::optional<MapView> view = view_of_frame(drive(corridor, 0, 1), 0);
      ASSERT_TRUE(view);
      EXPECT_FALSE(view->open_direction) << width_m << " m wide, noise " << noise_m << " m";
    }
}

TEST(OpenDirections, are_unknown_without_points) {
  EXPECT_FALSE(open_direction({}));
}

TEST(OpenDirections, need_motion_along_them) {
  const MappingResult along = drive({}, 0, 41);
  const std::vector<OpenStretch> stretches = open_stretches(along, map_views(along), 1);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0].first_frame, 1U);
  EXPECT_EQ(stretches[0].last_frame, 40U);
  EXPECT_NEAR(stretches[0].length_m, 10, 0.01);
  EXPECT_NEAR(stretches[0].at.x, 5, 0.5);
  EXPECT_TRUE(stretches[0].has_odometry);
  EXPECT_TRUE(open_stretches(along, map_views(along), 11).empty()) << "shorter than the least length";

  MappingResult across = drive({}, 0, 41);
  for (std::size_t i = 0; i < across.frames.size(); ++i)
    across.frames[i].map_T_robot = {0, 0.25 * static_cast<double>(i), 0};
  EXPECT_TRUE(open_stretches(across, map_views(across), 1).empty());
}

TEST(OpenDirections, end_at_a_new_run) {
  MappingResult result = drive({}, 0, 41);
  result.later_run_frames = {20};
  const std::vector<OpenStretch> stretches = open_stretches(result, map_views(result), 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_LT(stretches[0].last_frame, 20U);
  EXPECT_GT(stretches[1].first_frame, 20U);
}

TEST(OpenDirections, know_whether_odometry_measures_the_motion) {
  MappingResult result = drive({}, 0, 41);
  result.log[7].has_odometry = false;
  const std::vector<OpenStretch> stretches = open_stretches(result, map_views(result), 1);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_FALSE(stretches[0].has_odometry);
}

}  // namespace
}  // namespace psi_slam
