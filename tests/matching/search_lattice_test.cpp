// SPDX-License-Identifier: BSD-3-Clause
#include "matching/search_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "score_grids.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

double floor_divide(int a, int b) {
  return std::floor(static_cast<double>(a) / b);
}

// Returns the cell under a point of the scan at a pose of the robot. Sets `clear` to false if rounding errors
// can change the cell.
Cell slow_cell(const ScoreGrid& grid, const TPose2D& map_T_robot, const mrpt::math::TPoint2Df& point,
               bool& clear) {
  const auto x = static_cast<double>(point.x);
  const auto y = static_cast<double>(point.y);
  const double c = std::cos(map_T_robot.phi);
  const double s = std::sin(map_T_robot.phi);
  const double cell_x = (map_T_robot.x + c * x - s * y - grid.origin_x_m()) / grid.resolution_m();
  const double cell_y = (map_T_robot.y + s * x + c * y - grid.origin_y_m()) / grid.resolution_m();
  const auto near_an_edge = [](double v) { return std::abs(v - std::round(v)) < 1e-6; };
  clear = !near_an_edge(cell_x) && !near_an_edge(cell_y);
  return {static_cast<std::int32_t>(std::floor(cell_x)), static_cast<std::int32_t>(std::floor(cell_y))};
}

TEST(SearchLattice, poses_are_steps_from_the_centre) {
  std::mt19937_64 random(21);
  const ScoreGrid grid = random_grid(random, 10, 10, 4);
  const ScanPoints scan = random_points(random, 5, 1);
  const SearchLattice lattice(grid, scan, {1, 2, 3}, window_of_steps(10, 20, 30, 0.01));
  const TPose2D centre = lattice.pose({0, 0, 0});
  EXPECT_DOUBLE_EQ(centre.x, 1);
  EXPECT_DOUBLE_EQ(centre.y, 2);
  EXPECT_DOUBLE_EQ(centre.phi, 3);
  const TPose2D pose = lattice.pose({-3, 7, -5});
  EXPECT_DOUBLE_EQ(pose.x, 1 - 0.15);
  EXPECT_DOUBLE_EQ(pose.y, 2 + 0.35);
  EXPECT_DOUBLE_EQ(pose.phi, 3 - 0.05);
  EXPECT_NEAR(lattice.pose({0, 0, 20}).phi, 3.2 - 2 * M_PI, 1e-12) << "headings stay in (-pi, pi]";
}

TEST(SearchLattice, a_shift_by_cells_is_a_shift_of_the_pose) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> metres(-5, 5);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_int_distribution<int> step(-9, 9);
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const ScoreGrid grid = random_grid(random, 30, 20, 4);
    const ScanPoints scan = random_points(random, 20, 6);
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), angle(random)},
                                window_of_steps(9, 9, 9, 0.013));
    const LatticePose pose = {step(random), step(random), step(random)};
    for (std::size_t p = 0; p < scan.points.size(); ++p) {
      bool clear = false;
      const Cell expected = slow_cell(grid, lattice.pose(pose), scan.points[p], clear);
      if (!clear) continue;
      ++compared;
      EXPECT_EQ(lattice.cells(pose.theta)[p].x + pose.x, expected.x);
      EXPECT_EQ(lattice.cells(pose.theta)[p].y + pose.y, expected.y);
    }
  }
  EXPECT_GT(compared, 3900);
}

TEST(SearchLattice, response_is_the_share_of_the_largest_possible_sum) {
  std::mt19937_64 random(23);
  const ScoreGrid grid = random_grid(random, 10, 10, 4);
  const ScanPoints scan = random_points(random, 40, 1);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(1, 1, 1, 0.1));
  EXPECT_EQ(lattice.points(), 40U);
  EXPECT_EQ(lattice.goal_max(), 40U * 255U);
  EXPECT_EQ(lattice.response(lattice.goal_max()), 1);
  EXPECT_EQ(lattice.response(20 * 255), 0.5);
  EXPECT_EQ(lattice.response(0), 0);
}

TEST(ShiftSums, equal_the_slow_sum_of_clipped_and_unclipped_points) {
  std::mt19937_64 random(24);
  std::uniform_int_distribution<int> side(1, 60);
  std::uniform_int_distribution<int> block(1, 50);
  std::uniform_int_distribution<int> shift(-100, 100);
  std::uniform_int_distribution<std::int32_t> near(-120, 160);
  std::uniform_int_distribution<std::int32_t> far(-1'000'000, 1'000'000);
  ShiftSums sums;
  for (int trial = 0; trial < 300; ++trial) {
    const ScoreGrid grid = random_grid(random, side(random), side(random), 256);
    std::vector<Cell> cells;
    for (std::size_t p = 0; p < random() % 60; ++p) cells.push_back({near(random), near(random)});
    for (int p = 0; p < 3; ++p) cells.push_back({far(random), far(random)});
    cells.push_back({near(random), far(random)});
    cells.push_back({far(random), near(random)});
    const Cell shifted = {shift(random), shift(random)};
    const int width = block(random);
    const int height = block(random);
    const ScoreLevel* levels[] = {&grid.finest(), &grid.pyramid(0), &grid.pyramid(1)};
    for (const ScoreLevel* level : levels) {
      sums.compute(*level, cells.data(), cells.size(), shifted, width, height);
      const int stride = level->stride_cells();
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          std::uint32_t expected = 0;
          for (const Cell& cell : cells)
            expected += level->at(static_cast<int>(floor_divide(cell.x + shifted.x, stride)) + x,
                                  static_cast<int>(floor_divide(cell.y + shifted.y, stride)) + y);
          ASSERT_EQ(sums.row(y)[x], expected)
              << "trial " << trial << ", stride " << stride << ", (" << x << ", " << y << ")";
        }
      }
    }
  }
}

TEST(ShiftSums, of_no_points_are_zero) {
  std::mt19937_64 random(25);
  const ScoreGrid grid = random_grid(random, 10, 10, 4);
  ShiftSums sums;
  const Cell cell = {3, 3};
  sums.compute(grid.finest(), &cell, 1, {0, 0}, 5, 5);
  sums.compute(grid.finest(), &cell, 0, {0, 0}, 5, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(sums.row(y)[x], 0U) << "sums of the previous block are cleared";
}

TEST(Candidate, the_higher_sum_is_better_then_the_nearer_pose_then_the_lower_one) {
  const Candidate far_but_higher = {101, {50, 50, 50}};
  const Candidate near = {100, {1, 0, 0}};
  EXPECT_TRUE(far_but_higher.better_than(near));
  EXPECT_FALSE(near.better_than(far_but_higher));
  EXPECT_TRUE(near.better_than({100, {1, 1, 0}}));
  EXPECT_TRUE((Candidate{100, {0, 0, -1}}.better_than(near))) << "theta counts before y and x";
  EXPECT_TRUE((Candidate{100, {0, -1, 0}}.better_than(near))) << "then y";
  EXPECT_TRUE((Candidate{100, {-1, 0, 0}}.better_than(near))) << "then x";
  EXPECT_FALSE(near.better_than(near));
}

TEST(Candidate, distances_do_not_overflow) {
  const Candidate near = {1, {40'000, 40'000, 0}};
  const Candidate far = {1, {60'000, 60'000, 0}};
  EXPECT_TRUE(near.better_than(far));
  EXPECT_FALSE(far.better_than(near));
}

TEST(Candidate, the_order_is_total) {
  std::mt19937_64 random(26);
  std::uniform_int_distribution<int> step(-2, 2);
  std::vector<Candidate> candidates;
  for (int i = 0; i < 60; ++i)
    candidates.push_back(
        {static_cast<std::uint32_t>(random() % 2), {step(random), step(random), step(random)}});
  const auto equal = [](const Candidate& a, const Candidate& b) {
    return a.sum == b.sum && a.pose.x == b.pose.x && a.pose.y == b.pose.y && a.pose.theta == b.pose.theta;
  };
  for (const Candidate& a : candidates) {
    for (const Candidate& b : candidates) {
      ASSERT_EQ(a.better_than(b) || b.better_than(a), !equal(a, b));
      ASSERT_FALSE(a.better_than(b) && b.better_than(a));
      for (const Candidate& c : candidates)
        ASSERT_FALSE(a.better_than(b) && b.better_than(c) && !a.better_than(c));
    }
  }
}

TEST(ExcludedRegion, holds_the_poses_nearer_than_its_size_in_all_three) {
  const ExcludedRegion region = {{10, -5, 3}, 4, 2};
  EXPECT_TRUE(region.contains({10, -5, 3}));
  EXPECT_TRUE(region.contains({13, -8, 4}));
  EXPECT_TRUE(region.contains({7, -2, 2}));
  EXPECT_FALSE(region.contains({14, -5, 3}));
  EXPECT_FALSE(region.contains({6, -5, 3}));
  EXPECT_FALSE(region.contains({10, -1, 3}));
  EXPECT_FALSE(region.contains({10, -9, 3}));
  EXPECT_FALSE(region.contains({10, -5, 5}));
  EXPECT_FALSE(region.contains({10, -5, 1}));
}

}  // namespace
}  // namespace psi_slam
