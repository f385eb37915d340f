// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_drawing.h"

#include <gmock/gmock.h>

#include "map/exports/map_files.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Returns a free map of 10 m x 10 m around the origin with cells of 0.1 m and these occupied cells.
COccupancyGridMap2D map_with(const std::vector<std::pair<int, int>>& obstacles) {
  COccupancyGridMap2D grid(-5, 5, -5, 5, 0.1F);
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y) grid.setCell(x, y, 0.99F);
  for (const auto& [x, y] : obstacles) grid.setCell(x, y, 0.01F);
  return grid;
}

std::vector<std::pair<int, int>> block(int x_begin, int x_end, int y_begin, int y_end) {
  std::vector<std::pair<int, int>> cells;
  for (int x = x_begin; x < x_end; ++x)
    for (int y = y_begin; y < y_end; ++y) cells.emplace_back(x, y);
  return cells;
}

TEST(MapDrawing, an_outline_runs_through_the_centres_of_the_outermost_cells) {
  const MapDrawing drawing = draw_map_lines(map_with(block(20, 40, 60, 65)), {});
  ASSERT_EQ(drawing.walls.size(), 1U);
  ASSERT_EQ(drawing.walls[0].size(), 4U);
  for (const auto& corner : drawing.walls[0]) {
    EXPECT_NEAR(std::abs(corner.x - -2), 0.95, 1e-5);
    EXPECT_NEAR(std::abs(corner.y - 1.25), 0.2, 1e-5);
  }
}

TEST(MapDrawing, a_wall_of_one_cell_is_one_line_and_specks_are_left_out) {
  auto cells = block(20, 40, 60, 61);
  cells.emplace_back(80, 80);
  MapDrawingOptions options;
  options.min_wall_m = 0.2;
  const MapDrawing drawing = draw_map_lines(map_with(cells), {}, options);
  ASSERT_EQ(drawing.walls.size(), 1U);
  EXPECT_EQ(drawing.walls[0].size(), 2U);
}

TEST(MapDrawing, tolerance_smooths_the_steps_of_a_slanted_wall) {
  std::vector<std::pair<int, int>> cells;
  for (int i = 0; i < 60; ++i) cells.emplace_back(20 + i, 20 + i / 3);
  MapDrawingOptions options;
  options.tolerance_m = 0.1;
  EXPECT_EQ(draw_map_lines(map_with(cells), {}, options).walls.at(0).size(), 2U);
  options.tolerance_m = 0;
  EXPECT_GT(draw_map_lines(map_with(cells), {}, options).walls.at(0).size(), 30U);
}

TEST(MapDrawing, the_path_keeps_its_corners_and_widens_the_extent) {
  std::vector<mrpt::math::TPose2D> path;
  for (int i = 0; i <= 70; ++i) path.emplace_back(0.1 * i, 0, 0);
  for (int i = 0; i <= 20; ++i) path.emplace_back(7, 0.1 * i, 0);
  const MapDrawing drawing = draw_map_lines(map_with({}), {path, {{3, 7.5, 0}, {4, 7.5, 0}}});
  ASSERT_EQ(drawing.trajectories.size(), 2U) << "runs are not connected";
  ASSERT_EQ(drawing.trajectories[0].size(), 3U);
  EXPECT_NEAR(drawing.trajectories[0][1].x, 7, 1e-5);
  EXPECT_EQ(drawing.trajectories[1].size(), 2U);
  EXPECT_NEAR(drawing.extent.y_max_m, 7.5, 1e-5);
  EXPECT_NEAR(drawing.extent.x_max_m, 7, 1e-5);
  EXPECT_NEAR(drawing.extent.x_min_m, -5, 1e-5);
}

TEST(MapDrawing, empty_maps_give_files_and_equal_maps_equal_text) {
  const MapDrawing empty = draw_map_lines(COccupancyGridMap2D(-1, 1, -1, 1, 0.25F), {});
  EXPECT_TRUE(empty.walls.empty());
  EXPECT_THAT(map_svg(empty, 100), AllOf(HasSubstr("</svg>"), Not(HasSubstr("nan"))));
  EXPECT_THAT(map_dxf(empty), Not(HasSubstr("POLYLINE")));
  const MapDrawing drawing = draw_map_lines(map_with(block(20, 40, 60, 65)), {});
  EXPECT_EQ(map_svg(drawing, 100), map_svg(drawing, 100));
  EXPECT_EQ(map_dxf(drawing), map_dxf(drawing));
}

}  // namespace
}  // namespace psi_slam
