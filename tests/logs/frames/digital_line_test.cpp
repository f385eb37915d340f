// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/digital_line.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <vector>

namespace psi_slam {
namespace {

constexpr std::int64_t kStride = 1000;

using Cells = std::vector<std::int64_t>;

/// Bresenham's line by its running error, without its last cell.
Cells bresenham_by_error(int x0, int y0, int x1, int y1) {
  const int dx = std::abs(x1 - x0);
  const int dy = std::abs(y1 - y0);
  int error = dx - dy;
  Cells cells;
  for (int x = x0, y = y0; x != x1 || y != y1;) {
    cells.push_back(x + y * kStride);
    const int twice = 2 * error;
    if (twice > -dy) error -= dy, x += x1 > x0 ? 1 : -1;
    if (twice < dx) error += dx, y += y1 > y0 ? 1 : -1;
  }
  return cells;
}

Cells cells_of(const DigitalLine& line) {
  Cells cells;
  leap_line(line, [&](std::int64_t cell) {
    cells.push_back(cell);
    return std::int64_t{1};
  });
  return cells;
}

TEST(DigitalLine, is_bresenhams_line) {
  constexpr int kX = 400;
  constexpr int kY = 300;
  for (int dx = -70; dx <= 70; ++dx)
    for (int dy = -70; dy <= 70; ++dy)
      ASSERT_EQ(cells_of(bresenham_line(kX, kY, kX + dx, kY + dy, kStride)),
                bresenham_by_error(kX, kY, kX + dx, kY + dy))
          << dx << ' ' << dy;
}

TEST(DigitalLine, is_exact_for_long_lines) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> coordinate(-20'000, 20'000);
  for (int i = 0; i < 20; ++i) {
    const int x = coordinate(random);
    const int y = coordinate(random);
    ASSERT_EQ(cells_of(bresenham_line(0, 0, x, y, kStride)), bresenham_by_error(0, 0, x, y)) << x << ' ' << y;
    ASSERT_EQ(cells_of(bresenham_line(-x, -y, x, -y + i, kStride)), bresenham_by_error(-x, -y, x, -y + i));
  }
}

TEST(DigitalLine, leaps_over_cells) {
  const DigitalLine line = bresenham_line(3, 4, 90, 45, kStride);
  const Cells all = cells_of(line);
  Cells leapt;
  leap_line(line, [&](std::int64_t cell) {
    leapt.push_back(cell);
    return std::int64_t{7};
  });
  ASSERT_EQ(leapt.size(), (all.size() + 6) / 7);
  for (std::size_t i = 0; i < leapt.size(); ++i) EXPECT_EQ(leapt[i], all[7 * i]);
}

TEST(LineFan, crosses_the_cells_of_its_lines_but_seldom_twice) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> coordinate(0, 200);
  LineFan fan;
  for (int round = 0; round < 5; ++round) {
    fan.clear();
    std::set<std::int64_t> expected;
    std::size_t crossed = 0;
    Cells visited;
    // Lines from two points all around, as the scans of two lasers.
    for (const int start : {100, 107})
      for (int i = 0; i < 400; ++i) {
        const int side = i / 100;
        const int at = 2 * (i % 100);
        const int x = side == 0 ? at : side == 1 ? 200 : side == 2 ? 200 - at : 0;
        const int y = side == 0 ? 0 : side == 1 ? at : side == 2 ? 200 : 200 - at;
        const bool is_short = coordinate(random) < 60;
        const DigitalLine line =
            bresenham_line(start, 100, is_short ? (start + x) / 2 : x, is_short ? (100 + y) / 2 : y, kStride);
        const Cells cells = cells_of(line);
        expected.insert(cells.begin(), cells.end());
        crossed += cells.size();
        fan.walk(line, [&](std::int64_t cell) { visited.push_back(cell); });
      }
    EXPECT_EQ(std::set<std::int64_t>(visited.begin(), visited.end()), expected);
    EXPECT_LT(visited.size(), crossed * 3 / 4);
  }
}

}  // namespace
}  // namespace psi_slam
