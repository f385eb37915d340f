// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/wall_changes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "drawn_plan.h"
#include "localization/comparison/map_alignment.h"

namespace psi_slam {
namespace {

using Kind = WallChange::Kind;
using mrpt::math::TPose2D;

const TPose2D kPlanTB(7, 2, 2.2);  // a frame that crosses the cells of the plan

std::vector<WallChange> changes(const DrawnPlan& a, const DrawnPlan& b, const TPose2D& plan_T_b = {0, 0, 0}) {
  return find_wall_changes(map_of(a), map_of(b, plan_T_b), plan_T_b).changes;
}

DrawnPlan with_wall(const PlanWall& wall) {
  DrawnPlan plan;
  plan.walls.push_back(wall);
  return plan;
}

/// Expects one change between the maps, in frames that agree and in frames that do not.
WallChange only_change(const DrawnPlan& a, const DrawnPlan& b) {
  for (const TPose2D& plan_T_b : {kPlanTB, TPose2D(0, 0, 0)}) {
    const std::vector<WallChange> found = changes(a, b, plan_T_b);
    EXPECT_EQ(found.size(), 1U) << plan_T_b.asString();
    if (plan_T_b == TPose2D(0, 0, 0) && !found.empty()) return found.front();
  }
  return {};
}

TEST(WallChanges, equal_maps_have_none) {
  EXPECT_TRUE(changes({}, {}).empty());
  EXPECT_TRUE(changes({}, {}, kPlanTB).empty());
  EXPECT_TRUE(find_wall_changes(map_of({}), map_of({}, {0, 0, 0}, 0.1F), {0, 0, 0}).changes.empty())
      << "other cells";
}

TEST(WallChanges, finds_a_new_wall) {
  const WallChange change = only_change({}, with_wall({{1, 3}, {4, 3}}));
  EXPECT_EQ(change.kind, Kind::kAppeared);
  EXPECT_NEAR(change.length_m, 3, 0.1);
  EXPECT_NEAR(change.middle().x, 2.5, 0.1);
  EXPECT_NEAR(change.middle().y, 3, 0.1);
  EXPECT_NEAR(std::abs(change.to.x - change.from.x), 3, 0.1);
}

TEST(WallChanges, finds_a_wall_that_is_gone) {
  const WallChange change = only_change(with_wall({{6, 1}, {8, 3}}), {});
  EXPECT_EQ(change.kind, Kind::kVanished);
  EXPECT_NEAR(change.length_m, std::sqrt(8), 0.1);
}

TEST(WallChanges, finds_a_wall_that_moved) {
  const WallChange change = only_change(with_wall({{6, 2}, {8, 2}}), with_wall({{6, 2.4}, {8, 2.4}}));
  EXPECT_EQ(change.kind, Kind::kMoved);
  EXPECT_NEAR(change.length_m, 2, 0.1);
  EXPECT_NEAR(change.middle().y, 2, 0.1);
  EXPECT_NEAR(change.shift.x, 0, 0.1);
  EXPECT_NEAR(change.shift.y, 0.4, 0.06);
}

/// An empty hall with walls.
DrawnPlan hall_with(const std::vector<PlanWall>& walls) {
  DrawnPlan hall;
  hall.width_m = 14;
  hall.walls = {{{0, 0}, {14, 0}}, {{14, 0}, {14, 8}}, {{14, 8}, {0, 8}}, {{0, 8}, {0, 0}}};
  hall.walls.insert(hall.walls.end(), walls.begin(), walls.end());
  return hall;
}

TEST(WallChanges, one_of_two_walls_beside_the_old_place_has_appeared) {
  const auto found =
      changes(hall_with({{{4, 4}, {10, 4}}}), hall_with({{{4, 3.6}, {10, 3.6}}, {{4, 4.4}, {10, 4.4}}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, Kind::kAppeared);
  EXPECT_NEAR(found[0].length_m, 6, 0.1);
  EXPECT_EQ(found[1].kind, Kind::kMoved);
  EXPECT_NEAR(std::abs(found[1].shift.y), 0.4, 0.06);
  EXPECT_NEAR(found[0].middle().y, 4 - found[1].shift.y, 0.06) << "on the other side";
}

TEST(WallChanges, a_new_wall_beside_a_moved_wall_has_appeared) {
  const auto found =
      changes(hall_with({{{4, 4}, {10, 4}}}), hall_with({{{4, 4.3}, {10, 4.3}}, {{2, 3.3}, {12, 3.3}}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, Kind::kAppeared);
  EXPECT_NEAR(found[0].length_m, 10, 0.1);
  EXPECT_NEAR(found[0].middle().y, 3.3, 0.06);
  EXPECT_EQ(found[1].kind, Kind::kMoved);
  EXPECT_NEAR(found[1].length_m, 6, 0.1);
  EXPECT_NEAR(found[1].shift.y, 0.3, 0.06);
}

TEST(WallChanges, the_part_by_which_a_moved_wall_grew_has_appeared) {
  const auto found = changes(hall_with({{{2, 4}, {8, 4}}}), hall_with({{{2, 4.4}, {12, 4.4}}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, Kind::kAppeared);
  EXPECT_NEAR(found[0].length_m, 4, 0.25);
  EXPECT_NEAR(found[0].middle().x, 10, 0.15);
  EXPECT_EQ(found[1].kind, Kind::kMoved);
}

TEST(WallChanges, maps_that_lie_far_apart_share_nothing) {
  const WallChanges found = find_wall_changes(map_of({}), map_of({}), {5e5, 5e5, 0});
  EXPECT_EQ(found.compared_m2, 0);
  EXPECT_TRUE(found.cells.cells.empty());
}

TEST(WallChanges, a_wall_across_the_old_place_has_not_moved) {
  const auto found = changes(with_wall({{6, 2}, {8, 2}}), with_wall({{7, 2.3}, {7, 3.8}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, Kind::kAppeared);
  EXPECT_EQ(found[1].kind, Kind::kVanished);
}

/// The robot does not see behind a wall, so only one map shows the other place of an outer wall.
TEST(WallChanges, finds_an_outer_wall_that_moved_in_either_direction) {
  DrawnPlan narrow;
  DrawnPlan wide;
  wide.height_m = 8.5;
  wide.walls[1].second.y = 8.5;
  wide.walls[2] = {{12, 8.5}, {0, 8.5}};
  wide.walls[3].first.y = 8.5;
  wide.walls[5].second.y = 8.5;
  const auto expect_moved = [](const std::vector<WallChange>& found, double y_m, double shift_m) {
    ASSERT_EQ(found.size(), 2U) << "a partition divides the wall";
    for (const WallChange& change : found) {
      EXPECT_EQ(change.kind, Kind::kMoved);
      EXPECT_NEAR(change.middle().y, y_m, 0.1) << "the place in the first map";
      EXPECT_NEAR(change.shift.y, shift_m, 0.06);
    }
  };
  expect_moved(changes(narrow, wide), 8, 0.5);
  expect_moved(changes(wide, narrow), 8.5, -0.5);
}

TEST(WallChanges, space_that_one_map_does_not_show_is_no_change) {
  DrawnPlan part;
  part.seen_from_x_m = 4;
  EXPECT_TRUE(changes({}, part).empty());
  EXPECT_TRUE(changes(part, {}).empty());
  EXPECT_TRUE(changes(part, with_wall({{1, 3}, {3, 3}})).empty());
  const WallChanges found = find_wall_changes(map_of({}), map_of(part), {0, 0, 0});
  EXPECT_NEAR(found.compared_m2, 8 * 8, 1.5);
}

/// Returns the map with unknown space wherever `is_unknown` says so. Coordinates in metres.
mrpt::maps::COccupancyGridMap2D without(mrpt::maps::COccupancyGridMap2D map,
                                        bool (*is_unknown)(double x_m, double y_m)) {
  for (unsigned row = 0; row < map.getSizeY(); ++row)
    for (unsigned column = 0; column < map.getSizeX(); ++column)
      if (is_unknown(static_cast<double>(map.idx2x(column)), static_cast<double>(map.idx2y(row))))
        map.setCell(static_cast<int>(column), static_cast<int>(row), 0.5F);
  return map;
}

TEST(WallChanges, free_space_counts_only_with_free_space_on_both_sides) {
  const auto with = map_of(with_wall({{1, 3}, {4, 3}}));
  const auto is_change = [&](bool (*is_unknown)(double, double)) {
    const auto other = without(map_of({}), is_unknown);
    const bool vanished = !find_wall_changes(with, other, {0, 0, 0}).changes.empty();
    const bool appeared = !find_wall_changes(other, with, {0, 0, 0}).changes.empty();
    EXPECT_EQ(vanished, appeared);
    return vanished;
  };
  EXPECT_FALSE(is_change([](double, double y) { return std::abs(y - 3) > 0.03; })) << "a single beam";
  EXPECT_FALSE(is_change([](double, double y) { return y > 3.06; })) << "only the near side of a grazed wall";
  EXPECT_FALSE(is_change([](double, double y) { return std::abs(y - 3) > 0.13; }))
      << "two cells on each side, the tolerance is three";
  EXPECT_FALSE(is_change([](double x, double) { return std::fmod(x, 0.2) > 0.11; })) << "a fan of beams";
  EXPECT_TRUE(is_change([](double, double y) { return y > 3.3; }));
  EXPECT_TRUE(is_change([](double x, double y) {
    return std::fmod(x, 0.4) < 0.05 && std::fmod(y, 0.4) < 0.05;
  })) << "specks";
}

TEST(WallChanges, exchanging_the_maps_exchanges_the_changes) {
  const DrawnPlan a = hall_with({{{2, 2}, {5, 2}}, {{8, 2}, {8, 5}}, {{2, 6}, {2.4, 6}}, {{10, 6}, {12, 6}}});
  const DrawnPlan b =
      hall_with({{{2, 2.4}, {5.5, 2.4}}, {{8.4, 2}, {8.4, 4}}, {{3, 5.7}, {3, 6.3}}, {{11, 3}, {12, 3}}});
  const auto there = changes(a, b);
  const auto back = changes(b, a);
  const auto of_kind = [](const std::vector<WallChange>& found, Kind kind) {
    return std::count_if(found.begin(), found.end(),
                         [&](const WallChange& change) { return change.kind == kind; });
  };
  EXPECT_EQ(of_kind(there, Kind::kMoved), 2);
  EXPECT_EQ(of_kind(there, Kind::kVanished), 3) << "two walls, and 1 m of a moved wall";
  EXPECT_EQ(of_kind(there, Kind::kAppeared), 3) << "two walls, and 0.5 m of a moved wall";
  EXPECT_EQ(of_kind(back, Kind::kMoved), 2);
  EXPECT_EQ(of_kind(back, Kind::kVanished), 3);
  EXPECT_EQ(of_kind(back, Kind::kAppeared), 3);
}

TEST(WallChanges, a_perpendicular_new_wall_near_a_vanished_one_has_appeared) {
  const auto found = changes(hall_with({{{3, 4}, {3.4, 4}}}), hall_with({{{4, 3.7}, {4, 4.3}}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, Kind::kAppeared);
  EXPECT_NEAR(found[0].length_m, 0.6, 0.1);
  EXPECT_EQ(found[1].kind, Kind::kVanished);
  EXPECT_NEAR(found[1].length_m, 0.4, 0.1);
}

TEST(WallChanges, an_opened_door_has_changed) {
  DrawnPlan closed;
  closed.walls.push_back({{5, 3}, {5, 4}});
  EXPECT_EQ(only_change(closed, {}).kind, Kind::kVanished);
  EXPECT_EQ(only_change({}, closed).kind, Kind::kAppeared);
}

TEST(WallChanges, shifts_within_the_tolerance_and_specks_are_noise) {
  EXPECT_TRUE(changes({}, {}, TPose2D(0, 0, 0)).empty());
  EXPECT_TRUE(find_wall_changes(map_of({}), map_of({}), {0.1, 0.05, 0}).changes.empty());
  EXPECT_TRUE(find_wall_changes(map_of({}), map_of({}), {0.15, 0, 0}).changes.empty()) << "the tolerance";
  EXPECT_FALSE(find_wall_changes(map_of({}), map_of({}), {0.3, 0.3, 0}).changes.empty());
  EXPECT_TRUE(changes({}, with_wall({{2, 3}, {2.15, 3}})).empty());
  DrawnPlan dotted;
  for (int i = 0; i < 20; ++i) dotted.walls.push_back({{1 + 0.2 * i, 3}, {1.01 + 0.2 * i, 3}});
  EXPECT_TRUE(changes({}, dotted).empty()) << "the trail of a person";
}

TEST(WallChanges, the_cells_show_the_changes) {
  const WallChanges found = find_wall_changes(map_of({}), map_of(with_wall({{1, 3}, {4, 3}})), {0, 0, 0});
  const ComparedCells& cells = found.cells;
  const auto at = [&](double x_m, double y_m) {
    return cells.at(static_cast<int>((x_m - cells.x_min_m) / cells.cell_m),
                    static_cast<int>((y_m - cells.y_min_m) / cells.cell_m));
  };
  EXPECT_EQ(at(2, 3), ComparedCell::kAppeared);
  EXPECT_EQ(at(2, 2), ComparedCell::kFree);
  EXPECT_EQ(at(7, 4.5), ComparedCell::kWall);
  EXPECT_LT(cells.width * cells.cell_m, 12.2) << "no more than both maps show";
}

}  // namespace
}  // namespace psi_slam
