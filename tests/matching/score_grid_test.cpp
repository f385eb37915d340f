// SPDX-License-Identifier: BSD-3-Clause
#include "matching/score_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "score_grids.h"

namespace psi_slam {
namespace {

// Computes a cell of a pyramid level by its definition: the maximum over a square with sides of 2 `stride`.
std::uint8_t brute_force_maximum(const ScoreLevel& finest, int x, int y, int stride) {
  std::uint8_t largest = 0;
  for (int fine_y = y * stride; fine_y < (y + 2) * stride; ++fine_y)
    for (int fine_x = x * stride; fine_x < (x + 2) * stride; ++fine_x)
      largest = std::max(largest, finest.at(fine_x, fine_y));
  return largest;
}

// Interpolates by the Catmull-Rom spline through four values: Hermite's cubic with central differences as
// tangents.
double hermite(const std::array<double, 4>& p, double u) {
  const double m1 = (p[2] - p[0]) / 2;
  const double m2 = (p[3] - p[1]) / 2;
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * p[1] + (u3 - 2 * u2 + u) * m1 + (-2 * u3 + 3 * u2) * p[2] + (u3 - u2) * m2;
}

double slow_value(const ScoreGrid& grid, double x_m, double y_m) {
  const double x = (x_m - grid.origin_x_m()) / grid.resolution_m() - 0.5;
  const double y = (y_m - grid.origin_y_m()) / grid.resolution_m() - 0.5;
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  std::array<double, 4> rows{};
  for (int j = 0; j < 4; ++j) {
    std::array<double, 4> values{};
    for (int i = 0; i < 4; ++i) values[i] = grid.finest().at(column - 1 + i, row - 1 + j) / 255.0;
    rows[j] = hermite(values, x - column);
  }
  return hermite(rows, y - row);
}

TEST(ScoreGrid, every_level_holds_the_brute_force_maximum) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> side(1, 70);
  for (int trial = 0; trial < 50; ++trial) {
    const ScoreGrid grid = random_grid(random, side(random), side(random), trial % 2 == 0 ? 256 : 3);
    for (std::size_t i = 0; i < ScoreGrid::kStrides.size(); ++i) {
      const ScoreLevel& level = grid.pyramid(i);
      const int stride = ScoreGrid::kStrides[i];
      ASSERT_EQ(level.stride_cells(), stride);
      ASSERT_GE(level.width() * stride, grid.finest().width());
      ASSERT_GE(level.height() * stride, grid.finest().height());
      for (int y = -3; y < level.height() + 3; ++y)
        for (int x = -3; x < level.width() + 3; ++x)
          ASSERT_EQ(level.at(x, y), brute_force_maximum(grid.finest(), x, y, stride))
              << "cell (" << x << ", " << y << ") of stride " << stride << " in a grid of "
              << grid.finest().width() << " x " << grid.finest().height();
    }
  }
}

TEST(ScoreGrid, a_level_bounds_every_block_of_shifts) {
  std::mt19937_64 random(4);
  const ScoreGrid grid = random_grid(random, 45, 38, 256);
  std::uniform_int_distribution<int> place(-20, 60);
  for (int trial = 0; trial < 2000; ++trial) {
    const int x = place(random);
    const int y = place(random);
    for (std::size_t i = 0; i < ScoreGrid::kStrides.size(); ++i) {
      const int stride = ScoreGrid::kStrides[i];
      const auto floored = [&](int cell) { return (cell - ((cell % stride) + stride) % stride) / stride; };
      const std::uint8_t bound = grid.pyramid(i).at(floored(x), floored(y));
      for (int dy = 0; dy < stride; ++dy)
        for (int dx = 0; dx < stride; ++dx) ASSERT_LE(grid.finest().at(x + dx, y + dy), bound);
    }
  }
}

TEST(ScoreGrid, the_pyramid_follows_the_finest_grid_when_rebuilt) {
  ScoreGrid grid(0, 0, 0.05, 20, 20);
  EXPECT_FALSE(grid.has_pyramid());
  grid.build_pyramid();
  EXPECT_TRUE(grid.has_pyramid());
  EXPECT_EQ(grid.pyramid(1).at(1, 1), 0);
  *grid.finest().cell(17, 9) = 200;
  grid.build_pyramid();
  EXPECT_EQ(grid.pyramid(1).at(1, 1), 200);
  EXPECT_EQ(grid.pyramid(1).at(0, 0), 0);
}

TEST(ScoreLevel, is_surrounded_by_a_margin_of_zeros) {
  constexpr int kMargin = ScoreLevel::kMargin;
  ScoreLevel level(5, 4, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) *level.cell(x, y) = 255;
  for (int y = -kMargin - 2; y < 4 + kMargin + 2; ++y) {
    for (int x = -kMargin - 2; x < 5 + kMargin + 2; ++x) {
      const bool in_grid = x >= 0 && x < 5 && y >= 0 && y < 4;
      ASSERT_EQ(level.at(x, y), in_grid ? 255 : 0) << x << ", " << y;
      ASSERT_EQ(level.inside(x, y), x >= -kMargin && x < 5 + kMargin && y >= -kMargin && y < 4 + kMargin);
    }
  }
  EXPECT_EQ(level.cell(0, 1) - level.cell(0, 0), level.row_bytes());
}

TEST(ScoreGrid, vector_loads_from_its_last_cells_stay_in_memory) {
  const ScoreLevel level(3, 3, 1);
  const std::uint8_t* last = level.cell(3 + ScoreLevel::kMargin - 1, 3 + ScoreLevel::kMargin - 1);
  const std::uint8_t* end = level.cell(-ScoreLevel::kMargin, -ScoreLevel::kMargin) + level.memory_bytes();
  EXPECT_GE(end - last, ScoreLevel::kRunPadding);
}

TEST(ScoreGridInterpolation, passes_through_the_scores_at_cell_centres) {
  std::mt19937_64 random(5);
  const ScoreGrid grid = random_grid(random, 12, 9, 256);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 12; ++x)
      EXPECT_NEAR(
          grid.interpolate(grid.origin_x_m() + (x + 0.5) * 0.05, grid.origin_y_m() + (y + 0.5) * 0.05).value,
          grid.finest().at(x, y) / 255.0, 1e-5);
}

TEST(ScoreGridInterpolation, equals_the_textbook_spline) {
  std::mt19937_64 random(6);
  const ScoreGrid grid = random_grid(random, 30, 20, 256);
  std::uniform_real_distribution<double> x(-0.3, 1.8);
  std::uniform_real_distribution<double> y(-0.3, 1.3);
  for (int i = 0; i < 5000; ++i) {
    const double x_m = grid.origin_x_m() + x(random);
    const double y_m = grid.origin_y_m() + y(random);
    EXPECT_NEAR(grid.interpolate(x_m, y_m).value, slow_value(grid, x_m, y_m), 2e-6) << x_m << ", " << y_m;
  }
}

TEST(ScoreGridInterpolation, gradient_equals_numeric_derivatives) {
  std::mt19937_64 random(7);
  const ScoreGrid grid = random_grid(random, 30, 20, 256);
  std::uniform_real_distribution<double> x(-0.2, 1.7);
  std::uniform_real_distribution<double> y(-0.2, 1.2);
  constexpr double kStep = 1e-6;  // metres
  for (int i = 0; i < 5000; ++i) {
    const double x_m = grid.origin_x_m() + x(random);
    const double y_m = grid.origin_y_m() + y(random);
    const ScoreGrid::Sample sample = grid.interpolate(x_m, y_m);
    const auto slope = [&](double dx, double dy) {
      return (slow_value(grid, x_m + dx, y_m + dy) - slow_value(grid, x_m - dx, y_m - dy)) / (2 * kStep);
    };
    EXPECT_NEAR(sample.d_dx, slope(kStep, 0), 2e-3) << x_m << ", " << y_m;  // slopes reach 30 per metre
    EXPECT_NEAR(sample.d_dy, slope(0, kStep), 2e-3) << x_m << ", " << y_m;
  }
}

TEST(ScoreGridInterpolation, a_straight_ramp_stays_straight) {
  ScoreGrid grid(-1, 2, 0.05, 40, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) *grid.finest().cell(x, y) = static_cast<std::uint8_t>(4 * x + 2 * y);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> inner(0.1, 1.9);
  for (int i = 0; i < 500; ++i) {
    const double x = inner(random);
    const double y = inner(random);
    const ScoreGrid::Sample sample = grid.interpolate(-1 + x, 2 + y);
    EXPECT_NEAR(sample.value, (4 * (x / 0.05 - 0.5) + 2 * (y / 0.05 - 0.5)) / 255, 1e-5);
    EXPECT_NEAR(sample.d_dx, 4 / 0.05 / 255, 1e-4);
    EXPECT_NEAR(sample.d_dy, 2 / 0.05 / 255, 1e-4);
  }
}

TEST(ScoreGridInterpolation, is_zero_outside) {
  ScoreGrid grid(0, 0, 0.05, 10, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) *grid.finest().cell(x, y) = 255;
  for (const double far : {-100.0, -0.2, 0.7, 100.0}) {
    for (const double other : {0.25, far}) {
      for (const ScoreGrid::Sample& sample : {grid.interpolate(far, other), grid.interpolate(other, far)}) {
        EXPECT_EQ(sample.value, 0);
        EXPECT_EQ(sample.d_dx, 0);
        EXPECT_EQ(sample.d_dy, 0);
      }
    }
  }
  EXPECT_NEAR(grid.interpolate(0.25, 0.25).value, 1, 1e-6);
}

TEST(ScoreGrid, cropping_keeps_the_cells_and_their_places) {
  ScoreGrid grid(-1, 2, 0.05, 40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      *grid.finest().cell(x, y) = static_cast<std::uint8_t>((7 * x + 13 * y) % 256);
  const ScoreGrid part = grid.cropped(3, 5, 20, 10);
  EXPECT_DOUBLE_EQ(part.origin_x_m(), -0.85);
  EXPECT_DOUBLE_EQ(part.origin_y_m(), 2.25);
  EXPECT_EQ(part.finest().width(), 20);
  EXPECT_EQ(part.finest().height(), 10);
  for (int y = -1; y <= 10; ++y)
    for (int x = -1; x <= 20; ++x) {
      const bool inside = x >= 0 && x < 20 && y >= 0 && y < 10;
      EXPECT_EQ(part.finest().at(x, y), inside ? grid.finest().at(x + 3, y + 5) : 0);
    }
}

}  // namespace
}  // namespace psi_slam
