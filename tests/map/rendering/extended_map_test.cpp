// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/extended_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "map/rendering/map_image.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kTolerance_m = 0.15;
constexpr float kFree = 0.9F;
constexpr float kUnknown = 0.5F;
constexpr float kWall = 0.1F;

/// A hall of 6 m x 4 m with cells of 0.05 m, all of it free.
COccupancyGridMap2D hall() {
  COccupancyGridMap2D grid;
  grid.setSize(0, 6, 0, 4, 0.05F, 0.5F);
  grid.fill(kFree);
  return grid;
}

/// Sets columns [x, x + width) and rows [y, y + height).
void draw(COccupancyGridMap2D& grid, int x, int y, int width, int height, float cell) {
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column) grid.setCell(column, row, cell);
}

COccupancyGridMap2D hall_with_wall(int x = 0, int y = 40, int width = 120) {
  COccupancyGridMap2D grid = hall();
  draw(grid, x, y, width, 1, kWall);
  return grid;
}

COccupancyGridMap2D extended(const COccupancyGridMap2D& prior, const COccupancyGridMap2D& run) {
  return *extended_map(prior, run, kTolerance_m);
}

std::vector<std::string> walls_of(const COccupancyGridMap2D& grid) {
  std::vector<std::string> rows;
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y) {
    rows.emplace_back();
    for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
      rows.back() += is_occupied(grid.getRow(y)[x]) ? '#' : '.';
  }
  return rows;
}

bool is_wall(const COccupancyGridMap2D& grid, int x, int y) {
  return is_occupied(grid.getRow(y)[x]);
}

int count_walls(const COccupancyGridMap2D& grid, int x, int y, int width, int height) {
  int count = 0;
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column) count += is_wall(grid, column, row) ? 1 : 0;
  return count;
}

TEST(ExtendedMap, covers_both_maps_and_keeps_the_known_cells) {
  COccupancyGridMap2D prior;
  prior.setSize(-1, 1, 0, 1, 0.1F, 0.5F);
  prior.fill(0.9F);
  prior.setCell(prior.x2idx(0.55), prior.y2idx(0.55), kUnknown);
  COccupancyGridMap2D run;
  run.setSize(0, 3, 0, 1, 0.1F, 0.5F);
  run.fill(0.98F);
  const COccupancyGridMap2D both = extended(prior, run);
  EXPECT_FLOAT_EQ(both.getXMin(), -1);
  EXPECT_FLOAT_EQ(both.getXMax(), 3);
  EXPECT_NEAR(both.getPos(-0.95F, 0.45F), 0.9, 0.02);
  EXPECT_NEAR(both.getPos(0.95F, 0.45F), 0.9, 0.02);
  EXPECT_NEAR(both.getPos(0.55F, 0.55F), 0.98, 0.01);
  EXPECT_NEAR(both.getPos(1.05F, 0.45F), 0.98, 0.01);
  EXPECT_NEAR(both.getPos(2.95F, 0.95F), 0.98, 0.01);
}

TEST(ExtendedMap, refuses_other_cells) {
  COccupancyGridMap2D coarse;
  coarse.setSize(0, 1, 0, 1, 0.2F, 0.5F);
  EXPECT_THROW(extended_map(hall(), coarse, kTolerance_m), std::invalid_argument);
}

TEST(ExtendedMap, a_wall_that_both_show_stays_where_the_prior_map_has_it) {
  const COccupancyGridMap2D prior = hall_with_wall();
  for (const int shift : {-3, -1, 0, 1, 3})
    EXPECT_EQ(walls_of(extended(prior, hall_with_wall(0, 40 + shift))), walls_of(prior)) << shift;
}

TEST(ExtendedMap, a_wall_seen_anew_is_not_drawn_into_unknown_space_behind_it) {
  COccupancyGridMap2D prior = hall_with_wall();
  draw(prior, 0, 41, 120, 39, kUnknown);
  COccupancyGridMap2D run = hall_with_wall(0, 42);
  draw(run, 0, 43, 120, 37, kUnknown);
  const COccupancyGridMap2D both = extended(prior, run);
  EXPECT_EQ(walls_of(both), walls_of(prior));
  for (int x = 0; x < 120; ++x) EXPECT_EQ(both.getRow(42)[x], 0) << x;
}

TEST(ExtendedMap, a_wall_that_is_gone_is_removed) {
  EXPECT_EQ(walls_of(extended(hall_with_wall(30, 40, 60), hall())), walls_of(hall()));
}

TEST(ExtendedMap, a_door_that_was_opened_is_open_up_to_its_jambs) {
  COccupancyGridMap2D run = hall_with_wall();
  draw(run, 50, 40, 18, 1, kFree);  // 0.9 m
  const COccupancyGridMap2D both = extended(hall_with_wall(), run);
  EXPECT_EQ(count_walls(both, 0, 40, 50, 1), 50);
  EXPECT_EQ(count_walls(both, 51, 40, 16, 1), 0);
  EXPECT_EQ(count_walls(both, 68, 40, 52, 1), 52);
}

TEST(ExtendedMap, a_door_that_opens_and_closes_with_jitter_leaves_the_wall_beside_it) {
  COccupancyGridMap2D map = hall_with_wall();
  for (int day = 0; day < 20; ++day) {
    COccupancyGridMap2D run = hall_with_wall(0, 40 + day % 3 - 1);
    if (day % 2 == 0) draw(run, 50, 38, 18, 5, kFree);
    map = extended(map, run);
    EXPECT_EQ(count_walls(map, 0, 40, 50, 1), 50) << day;
    EXPECT_EQ(count_walls(map, 68, 40, 52, 1), 52) << day;
    EXPECT_EQ(count_walls(map, 0, 30, 48, 20), 48) << day;
    EXPECT_EQ(count_walls(map, 70, 30, 50, 20), 50) << day;
    if (day % 2 == 0) {
      EXPECT_EQ(count_walls(map, 52, 30, 14, 20), 0) << day;
    } else {
      EXPECT_GE(count_walls(map, 50, 38, 18, 5), 12) << day;
    }
  }
}

TEST(ExtendedMap, a_pallet_that_appeared_is_drawn) {
  COccupancyGridMap2D run = hall();
  draw(run, 40, 20, 24, 16, kWall);
  draw(run, 41, 21, 22, 14, kUnknown);
  EXPECT_EQ(walls_of(extended(hall(), run)), walls_of(run));
}

// Draws a cupboard against the wall in row `y`.
void put_cupboard(COccupancyGridMap2D& grid, int x, int y) {
  draw(grid, x, y - 10, 21, 1, kWall);
  draw(grid, x, y - 10, 1, 10, kWall);
  draw(grid, x + 20, y - 10, 1, 10, kWall);
  draw(grid, x + 1, y - 9, 19, 50, kUnknown);
}

TEST(ExtendedMap, an_object_against_a_wall_is_drawn_up_to_the_tolerance_and_hides_the_wall) {
  COccupancyGridMap2D run = hall_with_wall();
  put_cupboard(run, 40, 40);
  const COccupancyGridMap2D both = extended(hall_with_wall(), run);
  EXPECT_EQ(count_walls(both, 40, 30, 21, 7), 21 + 2 * 6);
  EXPECT_EQ(count_walls(both, 0, 37, 120, 3), 0);
  EXPECT_EQ(count_walls(both, 0, 40, 120, 1), 120);
}

TEST(ExtendedMap, objects_that_come_and_go_leave_nothing) {
  std::mt19937 random(3);
  const COccupancyGridMap2D prior = hall_with_wall();
  COccupancyGridMap2D map = prior;
  for (int day = 0; day < 50; ++day) {
    const int y = 39 + static_cast<int>(random() % 3U);
    COccupancyGridMap2D run = hall_with_wall(0, y);
    if (day % 2 == 0) put_cupboard(run, 5 + static_cast<int>(random() % 90U), y);
    map = extended(map, run);
    EXPECT_EQ(walls_of(map) == walls_of(prior), day % 2 == 1) << day;
  }
}

TEST(ExtendedMap, the_wall_of_a_run_continues_that_of_the_prior_map) {
  COccupancyGridMap2D prior = hall_with_wall(0, 40, 60);
  draw(prior, 60, 0, 60, 80, kUnknown);
  const COccupancyGridMap2D both = extended(prior, hall_with_wall());
  EXPECT_EQ(walls_of(both), walls_of(hall_with_wall()));
}

TEST(ExtendedMap, places_that_the_run_does_not_see_stay) {
  COccupancyGridMap2D run = hall();
  draw(run, 30, 30, 60, 50, kUnknown);  // hidden by an object in front of the wall
  const COccupancyGridMap2D prior = hall_with_wall(40, 50, 40);
  EXPECT_EQ(walls_of(extended(prior, run)), walls_of(prior));
}

TEST(ExtendedMap, free_space_on_one_side_of_a_wall_is_no_evidence) {
  COccupancyGridMap2D run = hall();
  draw(run, 0, 41, 120, 39, kUnknown);  // grazing beams cleared the wall itself
  const COccupancyGridMap2D prior = hall_with_wall();
  EXPECT_EQ(walls_of(extended(prior, run)), walls_of(prior));
}

TEST(ExtendedMap, a_hole_that_grazing_beams_left_stays_closed_and_a_lone_speck_is_removed) {
  COccupancyGridMap2D run = hall_with_wall();
  draw(run, 50, 40, 8, 1, kFree);  // 0.4 m
  const COccupancyGridMap2D wall = hall_with_wall();
  COccupancyGridMap2D prior = wall;
  draw(prior, 20, 20, 2, 1, kWall);
  EXPECT_EQ(walls_of(extended(prior, run)), walls_of(wall));
}

TEST(ExtendedMap, fifty_runs_with_jittered_walls_change_no_wall) {
  std::mt19937 random(1);
  const auto room = [](int x, int y) {
    COccupancyGridMap2D grid = hall();
    for (const int row : {10, 60}) draw(grid, 10 + x, row + y, 100, 1, kWall);
    for (const int column : {10, 110}) draw(grid, column + x, 10 + y, 1, 51, kWall);
    for (int i = 0; i < 30; ++i) grid.setCell(30 + i + x, 20 + i + y, kWall);  // at 45 degrees
    draw(grid, 0, 0, 120, 9 + y, kUnknown);
    draw(grid, 0, 62 + y, 120, 18 - y, kUnknown);
    return grid;
  };
  const COccupancyGridMap2D prior = room(0, 0);
  COccupancyGridMap2D map = prior;
  std::uniform_int_distribution<int> jitter(-1, 1);
  for (int day = 0; day < 50; ++day) {
    const int x = jitter(random);
    const int y = jitter(random);
    map = extended(map, room(x, y));
    ASSERT_EQ(walls_of(map), walls_of(prior)) << day;
  }
}

// Each wall of the run is in the extended map within the tolerance, and no wall is removed that the run does
// not show as free.
TEST(ExtendedMap, no_wall_of_random_maps_gets_lost) {
  std::mt19937 random(2);
  const auto random_map = [&] {
    COccupancyGridMap2D grid = hall();
    const auto pick = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
    for (int i = 0; i < 6; ++i) draw(grid, pick(90), pick(60), 5 + pick(25), 5 + pick(15), kUnknown);
    for (int i = 0; i < 25; ++i) {
      const bool is_flat = i % 2 == 0;
      draw(grid, pick(90), pick(50), is_flat ? 1 + pick(30) : 1 + pick(3), is_flat ? 1 + pick(3) : pick(30),
           kWall);
    }
    return grid;
  };
  for (int i = 0; i < 20; ++i) {
    const COccupancyGridMap2D prior = random_map();
    const COccupancyGridMap2D run = random_map();
    const COccupancyGridMap2D both = extended(prior, run);
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 120; ++x) {
        const bool is_hidden = is_wall(prior, x, y) && !is_free(run.getRow(y)[x]);
        EXPECT_TRUE(!is_hidden || is_wall(both, x, y)) << x << ' ' << y;
        EXPECT_TRUE(!is_wall(both, x, y) || is_wall(prior, x, y) || is_wall(run, x, y)) << x << ' ' << y;
        if (!is_wall(run, x, y)) continue;
        bool is_near = false;
        for (int dy = -3; dy <= 3; ++dy)
          for (int dx = -3; dx <= 3; ++dx)
            if (dx * dx + dy * dy <= 9 && x + dx >= 0 && x + dx < 120 && y + dy >= 0 && y + dy < 80)
              is_near = is_near || is_wall(both, x + dx, y + dy);
        EXPECT_TRUE(is_near) << x << ' ' << y;
      }
    }
  }
}

}  // namespace
}  // namespace psi_slam
