// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/cell_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <set>

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr std::int64_t kStride = 300;

TEST(CellBox, lines_keep_to_the_beam_and_end_before_its_last_cell) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(2, 298);
  for (int i = 0; i < 2000; ++i) {
    const TPoint2D start(coordinate(random), coordinate(random));
    const TPoint2D end(coordinate(random), coordinate(random));
    const TPoint2D along = (end - start) * (1 / (end - start).norm());
    std::int64_t cells = 0;
    leap_line(digital_line(start, end, kStride), [&](std::int64_t cell) {
      const TPoint2D middle(static_cast<double>(cell % kStride) + 0.5,
                            static_cast<double>(cell / kStride) + 0.5);
      const TPoint2D off = middle - start;
      EXPECT_LT(std::abs(along.x * off.y - along.y * off.x), 0.75) << "distance from the beam in cells";
      ++cells;
      return std::int64_t{1};
    });
    const auto between = [](double a, double b) { return std::abs(std::floor(a) - std::floor(b)); };
    const bool is_steep = std::abs(end.x - start.x) < std::abs(end.y - start.y);
    EXPECT_EQ(static_cast<double>(cells), is_steep ? between(start.y, end.y) : between(start.x, end.x));
  }
}

TEST(CellBox, a_fan_crosses_the_cells_of_its_lines) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0.1, 1);
  for (int round = 0; round < 5; ++round) {
    LineFan fan;
    std::set<std::int64_t> crossed;
    std::set<std::int64_t> expected;
    const TPoint2D start(150 + share(random), 150 + share(random));
    for (int beam = 0; beam < 720; ++beam) {
      const double angle_rad = beam * M_PI / 360;
      const double length = 140 * share(random);
      const TPoint2D end(start.x + length * std::cos(angle_rad), start.y + length * std::sin(angle_rad));
      const TPoint2D between = start + (end - start) * 0.7;
      for (const DigitalLine& line :
           {digital_line(start, between, kStride), digital_line(between, end, kStride)}) {
        fan.walk(line, [&](std::int64_t cell) { crossed.insert(cell); });
        leap_line(line, [&](std::int64_t cell) {
          expected.insert(cell);
          return std::int64_t{1};
        });
      }
    }
    EXPECT_EQ(crossed, expected);
  }
}

}  // namespace
}  // namespace psi_slam
