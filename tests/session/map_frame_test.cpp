// SPDX-License-Identifier: BSD-3-Clause
#include "session/map_frame.h"

#include <gmock/gmock.h>

#include "map/exports/mapped_trajectory.h"
#include "simulated_room.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;

TEST(MapFrame, none_keeps_the_frame_of_the_mapper) {
  EXPECT_EQ(export_T_map(walk_around_the_room(), {}), TPose2D(0, 0, 0));
}

TEST(MapFrame, an_angle_and_an_origin_move_the_map) {
  const TPose2D frame = export_T_map(walk_around_the_room(), {"90", 3, -1});
  const auto point = frame.composePoint({2, 1});  // (-1, 2) in the turned map
  EXPECT_NEAR(point.x, -4, 1e-12);
  EXPECT_NEAR(point.y, 3, 1e-12);
}

TEST(MapFrame, walls_lays_the_walls_along_the_axes) {
  MappingResult result = walk_around_the_room();
  const TPose2D turned(0, 0, 0.4);
  for (FrameRecord& frame : result.frames) frame.map_T_robot = turned + frame.map_T_robot;
  EXPECT_NEAR(export_T_map(result, {"walls"}).phi, -0.4, 0.002);
}

TEST(MapFrame, all_poses_move_and_return_bit_for_bit) {
  MappingResult result = walk_around_the_room();
  const MappingResult before = result;
  {
    const ExportedPoses exported(result, {1, 2, 0.3});
    const std::size_t last = result.graph.num_nodes() - 1;
    const TPose2D scan = result.frames[result.node_frames[last]].map_T_robot;
    const TPose2D expected = TPose2D(1, 2, 0.3) + before.graph.pose(last);
    EXPECT_NEAR(result.graph.pose(last).x, expected.x, 1e-12);
    EXPECT_NEAR(scan.x, expected.x, 1e-12) << "scans and nodes agree";
    EXPECT_NEAR(scan.phi, expected.phi, 1e-12);
    EXPECT_NE(result.frames[0].map_T_robot, before.frames[0].map_T_robot);
  }
  EXPECT_EQ(mapped_poses(result), mapped_poses(before));
  EXPECT_EQ(result.graph.poses(), before.graph.poses());
}

TEST(MapFrame, an_unknown_value_is_refused) {
  Settings settings;
  settings.map_frame.align = "square";
  EXPECT_THAT(sentence_of([&] { check(settings); }), HasSubstr("map.align = square: expected walls, none"));
  settings.map_frame.align = "-12.5";
  EXPECT_NO_THROW(check(settings));
}

}  // namespace
}  // namespace psi_slam
