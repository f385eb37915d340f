// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_edits.h"

#include <gmock/gmock.h>

#include "map/rendering/map_image.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Grid = mrpt::maps::COccupancyGridMap2D;
using Kind = MapEdit::Kind;

enum class Shown { kWall, kFree, kUnknown };

Shown shown(const Grid& grid, double x_m, double y_m) {
  const auto cell = grid.getRow(grid.y2idx(y_m))[grid.x2idx(x_m)];
  return psi_slam::is_occupied(cell) ? Shown::kWall
         : psi_slam::is_free(cell)   ? Shown::kFree
                                     : Shown::kUnknown;
}

/// Free space with one wall at x = 1.025 m. The lower left corner is at (-2, -1) m.
Grid walled_map() {
  Grid grid(-2, 4, -1, 3, 0.05F);
  grid.fill(0.97F);
  for (double y = -0.975; y < 3; y += 0.05) grid.setCell(grid.x2idx(1.01), grid.y2idx(y), 0.02F);
  return grid;
}

MapEdit polygon(Kind kind, double x_min, double x_max, double y_min, double y_max) {
  MapEdit edit;
  edit.kind = kind;
  edit.points = {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}};
  return edit;
}

TEST(MapEdits, polygons_become_free_or_unknown_and_nothing_else_changes) {
  Grid grid = walled_map();
  EXPECT_THAT(
      apply_map_edits({polygon(Kind::kErase, 0, 2, 0, 1), polygon(Kind::kUnknown, 2, 3, 2, 2.5)}, grid),
      IsEmpty());
  EXPECT_EQ(shown(grid, 1.01, 0.5), Shown::kFree);
  EXPECT_EQ(shown(grid, 1.01, 1.03), Shown::kWall);
  EXPECT_EQ(shown(grid, 1.01, -0.03), Shown::kWall);
  EXPECT_EQ(shown(grid, 2.5, 2.25), Shown::kUnknown);
  EXPECT_EQ(shown(grid, 2.5, 2.55), Shown::kFree);
}

TEST(MapEdits, a_polygon_may_be_concave) {
  Grid grid = walled_map();
  MapEdit corner;
  corner.kind = Kind::kUnknown;
  corner.points = {{-1, 0}, {0.5, 0}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, 2}, {-1, 2}};
  apply_map_edits({corner}, grid);
  EXPECT_EQ(shown(grid, 0.3, 0.3), Shown::kUnknown);
  EXPECT_EQ(shown(grid, -0.8, 1.8), Shown::kUnknown);
  EXPECT_EQ(shown(grid, 0.3, 1.0), Shown::kFree);
}

TEST(MapEdits, a_wall_has_its_width_and_no_gaps) {
  Grid grid = walled_map();
  MapEdit thin;
  thin.kind = Kind::kWall;
  thin.points = {{-1.5, -0.5}, {0.5, 0.3}, {0.5, 2}};
  MapEdit thick = thin;
  thick.points = {{2, 1}, {3, 1}};
  thick.width_m = 0.3;
  apply_map_edits({thin, thick}, grid);
  for (double t = 0; t <= 1; t += 0.01)
    EXPECT_EQ(shown(grid, -1.5 + 2 * t, -0.5 + 0.8 * t), Shown::kWall) << t;
  EXPECT_EQ(shown(grid, 0.51, 1.5), Shown::kWall);
  EXPECT_EQ(shown(grid, 0.6, 1.5), Shown::kFree);
  EXPECT_EQ(shown(grid, 2.5, 1.13), Shown::kWall);
  EXPECT_EQ(shown(grid, 2.5, 1.2), Shown::kFree);
}

TEST(MapEdits, a_wall_on_a_border_of_cells_is_drawn) {
  MapEdit wall;
  wall.kind = Kind::kWall;
  wall.points = {{0, -0.5}, {0, 0.5}};
  for (int i = 0; i < 600; ++i) {
    const float x_min_m = -30 + 0.05F * static_cast<float>(i);
    Grid grid(x_min_m, 1, -1, 1, 0.05F);
    grid.fill(0.97F);
    EXPECT_THAT(apply_map_edits({wall}, grid), IsEmpty()) << x_min_m;
    const bool left = shown(grid, -0.02, 0.02) == Shown::kWall;
    const bool right = shown(grid, 0.02, 0.02) == Shown::kWall;
    EXPECT_TRUE(left || right) << x_min_m;
  }
}

TEST(MapEdits, later_edits_override_earlier_ones) {
  Grid grid = walled_map();
  apply_map_edits({polygon(Kind::kUnknown, 0, 2, 0, 1), polygon(Kind::kErase, 0, 2, 0, 1)}, grid);
  EXPECT_EQ(shown(grid, 1.01, 0.5), Shown::kFree);
}

TEST(MapEdits, a_cropped_map_has_the_same_cells_at_the_same_place) {
  Grid grid = walled_map();
  apply_map_edits({polygon(Kind::kCrop, 0, 2, 0.5, 5)}, grid);
  EXPECT_NEAR(grid.getXMin(), 0, 1e-5);
  EXPECT_NEAR(grid.getXMax(), 2, 1e-5);
  EXPECT_NEAR(grid.getYMin(), 0.5, 1e-5);
  EXPECT_NEAR(grid.getYMax(), 3, 1e-5) << "not beyond the map";
  EXPECT_EQ(shown(grid, 1.01, 1), Shown::kWall);
  EXPECT_EQ(shown(grid, 1.07, 1), Shown::kFree);
}

TEST(MapEdits, a_cropped_map_has_no_border_of_unknown_cells) {
  for (int i = 0; i < 200; ++i) {
    const float min_m = -30 + 0.05F * static_cast<float>(i);
    Grid grid(min_m, 8, min_m - 1, 9, 0.05F);
    grid.fill(0.97F);
    const double side_m = 0.05 * (1 + i);
    apply_map_edits({polygon(Kind::kCrop, -side_m, 5, -2, side_m)}, grid);  // at last beyond the map
    ASSERT_EQ(grid.getSizeX(), 101U + static_cast<unsigned>(i)) << i;
    ASSERT_EQ(grid.getSizeY(), std::min(220U, 41U + static_cast<unsigned>(i))) << i;
    ASSERT_NEAR(grid.getXMin(), -side_m, 1e-4) << i;
    ASSERT_NEAR(grid.getYMin(), -2, 1e-4) << i;
    for (unsigned x = 0; x < grid.getSizeX(); ++x)
      for (unsigned y = 0; y < grid.getSizeY(); ++y)
        ASSERT_TRUE(psi_slam::is_free(grid.getRow(static_cast<int>(y))[x])) << i << ": " << x << ", " << y;
  }
}

TEST(MapEdits, a_cropped_map_has_the_cells_whose_centres_lie_in_the_rectangle) {
  Grid grid = walled_map();
  apply_map_edits({polygon(Kind::kCrop, 0.02, 0.18, 0.03, 0.12)}, grid);
  EXPECT_EQ(grid.getSizeX(), 4U);
  EXPECT_EQ(grid.getSizeY(), 1U);
  EXPECT_NEAR(grid.getXMin(), 0, 1e-5);
  EXPECT_NEAR(grid.getYMin(), 0.05, 1e-5);
}

TEST(MapEdits, zones_change_nothing_and_edits_beside_the_map_are_reported) {
  Grid grid = walled_map();
  EXPECT_THAT(apply_map_edits({polygon(Kind::kKeepOut, 0, 2, 0, 1)}, grid), IsEmpty());
  EXPECT_EQ(grid.getRawMap(), walled_map().getRawMap());
  EXPECT_THAT(apply_map_edits({polygon(Kind::kCrop, 40, 50, 0, 1)}, grid),
              ElementsAre(HasSubstr("crop at 40,0: no cell of the map lies there")));
  EXPECT_EQ(grid.getSizeX(), walled_map().getSizeX());
  EXPECT_THAT(apply_map_edits({polygon(Kind::kSlow, -1.5, -1, 0, 1), polygon(Kind::kCrop, 0, 2, 0, 1)}, grid),
              ElementsAre(HasSubstr("slow at -1.5,0: no cell of the map lies there")))
      << "the zone was cropped away";
}

}  // namespace
}  // namespace psi_slam
