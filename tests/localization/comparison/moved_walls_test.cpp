// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/moved_walls.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

const WallMoveLimits kLimits{20, 3, 6};

/// Cells of a straight wall from (x0, y0) to (x1, y1).
WallCells line(double x0, double y0, double x1, double y1) {
  WallCells cells;
  const int steps = static_cast<int>(std::max(std::abs(x1 - x0), std::abs(y1 - y0)));
  for (int i = 0; i <= steps; ++i)
    cells.emplace_back(static_cast<int>(std::lround(x0 + (x1 - x0) * i / steps)),
                       static_cast<int>(std::lround(y0 + (y1 - y0) * i / steps)));
  return cells;
}

struct Outcome {
  std::vector<ChangedWall> gone;
  std::vector<ChangedWall> appeared;
  std::vector<MovedWall> moved;
};

Outcome moves(const std::vector<WallCells>& gone, const std::vector<WallCells>& appeared) {
  const auto walls_of = [](const std::vector<WallCells>& lines) {
    WallCells all;
    for (const WallCells& cells : lines) all.insert(all.end(), cells.begin(), cells.end());
    return connected_walls(all, kLimits.min_length);
  };
  Outcome outcome{walls_of(gone), walls_of(appeared), {}};
  outcome.moved = take_moved_walls(outcome.gone, outcome.appeared, kLimits);
  return outcome;
}

void expect_counts(const Outcome& outcome, std::size_t gone, std::size_t appeared, std::size_t moved) {
  EXPECT_EQ(outcome.gone.size(), gone);
  EXPECT_EQ(outcome.appeared.size(), appeared);
  EXPECT_EQ(outcome.moved.size(), moved);
}

/// Expects the counts, and with both lists exchanged the opposite. Returns the outcome.
Outcome expect_moves(const std::vector<WallCells>& old_walls, const std::vector<WallCells>& new_walls,
                     std::size_t gone, std::size_t appeared, std::size_t moved) {
  Outcome outcome = moves(old_walls, new_walls);
  const Outcome back = moves(new_walls, old_walls);
  expect_counts(outcome, gone, appeared, moved);
  expect_counts(back, appeared, gone, moved);
  for (std::size_t i = 0; i < std::min(back.moved.size(), outcome.moved.size()); ++i)
    EXPECT_EQ(back.moved[i].shift, -outcome.moved[i].shift);
  return outcome;
}

TEST(MovedWalls, a_wall_moves_across_its_direction) {
  const Outcome outcome = expect_moves({line(50, 50, 90, 50)}, {line(50, 60, 90, 60)}, 0, 0, 1);
  EXPECT_EQ(outcome.moved.at(0).shift, cv::Point2d(0, 10));
  EXPECT_EQ(outcome.moved.at(0).wall.length(), 41);
  const Outcome tilted = expect_moves({line(50, 50, 90, 70)}, {line(46, 58, 86, 78)}, 0, 0, 1);
  EXPECT_NEAR(tilted.moved.at(0).shift.x, -4, 0.7);
  EXPECT_NEAR(tilted.moved.at(0).shift.y, 8, 0.7);
}

TEST(MovedWalls, neither_a_perpendicular_wall_nor_one_ahead_is_the_new_place) {
  expect_moves({line(60, 50, 68, 50)}, {line(80, 44, 80, 56)}, 1, 1, 0);
  expect_moves({line(60, 50, 68, 50)}, {line(72, 44, 72, 56)}, 1, 1, 0);
  expect_moves({line(60, 50, 68, 50)}, {line(64, 54, 64, 66)}, 1, 1, 0);
  expect_moves({line(60, 50, 68, 50)}, {line(75, 50, 83, 50)}, 1, 1, 0);
  expect_moves({line(60, 50, 90, 50)}, {line(60, 55, 86, 70)}, 1, 1, 0);
}

TEST(MovedWalls, walls_of_other_lengths_or_too_far_away_are_other_walls) {
  expect_moves({line(60, 50, 67, 50)}, {line(20, 60, 180, 60)}, 1, 1, 0);
  expect_moves({line(50, 50, 90, 50)}, {line(50, 71, 90, 71)}, 1, 1, 0);
}

TEST(MovedWalls, the_rest_of_the_longer_wall_stays) {
  const Outcome outcome = expect_moves({line(20, 50, 80, 50)}, {line(20, 58, 120, 58)}, 0, 1, 1);
  EXPECT_NEAR(outcome.appeared.at(0).length(), 40, 1);
  EXPECT_NEAR(outcome.moved.at(0).wall.length(), 61, 1);
}

TEST(MovedWalls, a_wall_whose_new_place_is_divided_has_moved_in_two_parts) {
  expect_moves({line(20, 50, 120, 50)}, {line(20, 58, 80, 58), line(85, 58, 120, 58)}, 0, 0, 2);
}

TEST(MovedWalls, the_nearest_pairs_come_first) {
  const Outcome outcome =
      expect_moves({line(20, 50, 80, 50)}, {line(20, 42, 80, 42), line(20, 56, 80, 56)}, 0, 1, 1);
  EXPECT_EQ(outcome.moved.at(0).shift, cv::Point2d(0, 6));
  expect_moves({line(20, 50, 80, 50), line(20, 60, 80, 60)}, {line(20, 55, 80, 55)}, 1, 0, 1);
}

TEST(MovedWalls, finds_parallel_cells_among_others) {
  const ChangedWall wall = connected_walls(line(50, 50, 90, 50), kLimits.min_length).at(0);
  cv::Mat1b others(100, 120, std::uint8_t{0});
  const auto draw = [&](const WallCells& cells) {
    for (const cv::Point& cell : cells) others(cell) = 255;
  };
  draw(line(70, 55, 70, 75));
  EXPECT_FALSE(shift_to_parallel(wall, others, kLimits));
  draw(line(50, 62, 65, 62));
  EXPECT_FALSE(shift_to_parallel(wall, others, kLimits)) << "less than half";
  draw(line(50, 62, 90, 62));
  EXPECT_EQ(shift_to_parallel(wall, others, kLimits), cv::Point2d(0, 12));
}

}  // namespace
}  // namespace psi_slam
