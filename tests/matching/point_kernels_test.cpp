// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

// Point counts around the widths of vectors.
constexpr std::size_t kCounts[] = {0, 1, 3, 7, 8, 9, 15, 16, 17, 31, 33, 180, 1081};

std::vector<const PointKernels*> kernels_of_this_machine() {
  std::vector<const PointKernels*> kernels;
  for (const InstructionSet set : kInstructionSets)
    if (const PointKernels* found = point_kernels_for(set)) kernels.push_back(found);
  return kernels;
}

std::vector<float> random_coordinates(std::mt19937_64& random, std::size_t count, float extent) {
  std::uniform_real_distribution<float> draw(-extent, extent);
  std::vector<float> coordinates(count);
  for (float& coordinate : coordinates) coordinate = draw(random);
  return coordinates;
}

TEST(PointKernels, place_points_in_the_cells_of_exact_numbers) {
  std::mt19937_64 random(3);
  for (const std::size_t count : kCounts) {
    const std::vector<float> points = random_coordinates(random, 2 * count, 80);
    const CellPlacement<double> placement = {100.25, -7.5, 20 * std::cos(0.7), 20 * std::sin(0.7)};
    for (const PointKernels* kernels : kernels_of_this_machine()) {
      std::vector<Cell> cells(count);
      kernels->place(placement, points.data(), count, cells.data());
      for (std::size_t i = 0; i < count; ++i) {
        const double x = static_cast<double>(points[2 * i]);
        const double y = static_cast<double>(points[2 * i + 1]);
        EXPECT_EQ(cells[i].x, std::floor(placement.x0 + placement.cosine * x - placement.sine * y));
        EXPECT_EQ(cells[i].y, std::floor(placement.y0 + placement.sine * x + placement.cosine * y));
      }
    }
  }
}

// A table of squares that a search of this stride uses.
SquareSearch random_search(std::mt19937_64& random) {
  const auto up_to = [&](int last) { return std::uniform_int_distribution<int>(0, last)(random); };
  SquareSearch search;
  const float heading = static_cast<float>(up_to(628)) / 100;
  search.middle = {static_cast<float>(up_to(300)) + 0.3F, static_cast<float>(up_to(300)) - 0.6F,
                   std::cos(heading), std::sin(heading)};
  search.across = 0.02F;
  search.along = 0.0002F;
  search.rounding = 1e-4F;
  search.layout.log_phases = 1 + up_to(3);
  search.layout.phases = 1 << search.layout.log_phases;
  search.stride = 2 * search.layout.phases;
  search.window_columns = 1 + up_to(5);
  search.window_rows = 1 + up_to(5);
  search.layout.columns = search.window_columns;
  search.layout.rows = search.window_rows;
  search.layout.plane_columns = 10 + up_to(30);
  search.layout.plane_rows = 10 + up_to(30);
  search.layout.row_bytes = 64;
  search.layout.plane_bytes = 64 * 50;
  search.layout.table_bytes = search.layout.plane_bytes * search.layout.phases * search.layout.phases;
  return search;
}

// BoundLayout::offset() with numbers that cannot overflow.
std::int32_t slow_offset(const SquareSearch& search, int x, int y, int half_cells) {
  const BoundLayout& layout = search.layout;
  const auto divided = [&](int half_cell) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(half_cell) / layout.phases));
  };
  const std::int64_t column = divided(x);
  const std::int64_t row = divided(y);
  if (column + search.window_columns <= 0 || column >= layout.plane_columns) return -1;
  if (row + search.window_rows <= 0 || row >= layout.plane_rows) return -1;
  const std::int64_t plane = (y - row * layout.phases) * layout.phases + x - column * layout.phases;
  return static_cast<std::int32_t>(std::int64_t{half_cells - layout.phases} * layout.table_bytes +
                                   plane * layout.plane_bytes + (layout.rows + row) * layout.row_bytes +
                                   layout.columns + column);
}

// Whether the squares hold the points is tested with BoundLevel.
TEST(PointKernels, find_the_squares_of_plain_code) {
  std::mt19937_64 random(4);
  int inside = 0;
  for (const std::size_t count : kCounts) {
    const SquareSearch search = random_search(random);
    const std::vector<float> x = random_coordinates(random, count, 300);
    const std::vector<float> y = random_coordinates(random, count, 300);
    std::vector<std::int32_t> expected;
    for (std::size_t i = 0; i < count; ++i) {
      const float u = search.middle.cosine * x[i] - search.middle.sine * y[i];
      const float v = search.middle.sine * x[i] + search.middle.cosine * y[i];
      const float dx = std::abs(v) * search.across + std::abs(u) * search.along + search.rounding;
      const float dy = std::abs(u) * search.across + std::abs(v) * search.along + search.rounding;
      const auto half_cells = [&](float first, float last) {
        const int begin = static_cast<int>(std::floor(first)) >> 1;
        return std::pair(begin, ((static_cast<int>(std::floor(last)) + search.stride - 1) >> 1) - begin);
      };
      const auto [column, width] = half_cells(search.middle.x0 + u - dx, search.middle.x0 + u + dx);
      const auto [row, height] = half_cells(search.middle.y0 + v - dy, search.middle.y0 + v + dy);
      expected.push_back(slow_offset(search, column, row, std::max(width, height) + 1));
      inside += expected.back() >= 0 ? 1 : 0;
    }
    for (const PointKernels* kernels : kernels_of_this_machine()) {
      std::vector<std::int32_t> squares(count);
      kernels->find_squares(search, x.data(), y.data(), count, squares.data());
      EXPECT_EQ(squares, expected);
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(PointKernels, find_offsets_and_mark_cells_outside) {
  std::mt19937_64 random(5);
  std::uniform_int_distribution<int> draw(-200, 900);
  int clipped = 0;
  int inside = 0;
  for (const std::size_t count : kCounts) {
    UnclippedCells unclipped;
    unclipped.shift = {draw(random), draw(random)};
    unclipped.log_stride = static_cast<int>(count % 4);
    unclipped.first = {-16, -16};
    unclipped.last = {300, 200};
    unclipped.row_bytes = 337;
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < count; ++i) cells.push_back({draw(random), draw(random)});
    std::vector<std::int32_t> expected;
    for (const Cell& cell : cells) {
      const double stride = 1 << unclipped.log_stride;
      const auto x = static_cast<int>(std::floor((cell.x + unclipped.shift.x) / stride));
      const auto y = static_cast<int>(std::floor((cell.y + unclipped.shift.y) / stride));
      const bool is_inside = x >= -16 && x <= 300 && y >= -16 && y <= 200;
      expected.push_back(is_inside ? y * 337 + x : PointKernels::kClipped);
      ++(is_inside ? inside : clipped);
    }
    for (const PointKernels* kernels : kernels_of_this_machine()) {
      std::vector<std::int32_t> offsets(count);
      kernels->find_offsets(unclipped, cells.data(), count, offsets.data());
      EXPECT_EQ(offsets, expected);
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(clipped, 50);
}

std::vector<std::pair<std::size_t, const PointKernels*>> blocks_and_kernels() {
  std::vector<std::pair<std::size_t, const PointKernels*>> pairs;
  for (const std::size_t blocks : {1U, 2U, 5U})
    for (const PointKernels* kernels : kernels_of_this_machine()) pairs.emplace_back(blocks, kernels);
  return pairs;
}

TEST(PointKernels, merge_the_nearest_points_in_their_order) {
  std::mt19937_64 random(6);
  for (const std::size_t count : kCounts) {
    std::vector<float> x = random_coordinates(random, count, 3);
    std::vector<float> y = random_coordinates(random, count, 3);
    for (std::size_t i = 0; i + 1 < count; i += 4) {  // equally near points
      x[i + 1] = x[i];
      y[i + 1] = y[i];
    }
    std::vector<std::uint32_t> index(count);
    for (std::uint32_t i = 0; i < count; ++i) index[i] = (i * 7919U) % 1009U;
    std::vector<std::int64_t> sorted;
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = x[i] - 0.5F;
      const float dy = y[i] + 0.25F;
      const float square = dx * dx + dy * dy;
      std::int32_t bits = 0;
      std::memcpy(&bits, &square, sizeof bits);
      sorted.push_back((static_cast<std::int64_t>(bits) << 32) + index[i]);
    }
    // At first, all keys are that of the largest distance; the second one excludes some points.
    for (const std::int64_t no_point : {INT64_MAX, count > 0 ? sorted[count / 2] : std::int64_t{0}})
      for (const auto& [blocks, kernels] : blocks_and_kernels()) {
        std::vector<std::int64_t> expected = sorted;
        expected.resize(count + 8 * blocks, no_point);
        std::sort(expected.begin(), expected.end());
        expected.resize(8 * blocks);
        std::vector<std::int64_t> nearest(8 * blocks, no_point);
        const std::size_t half = count / 2;
        for (const auto& [begin, end] : {std::pair(half, count), std::pair(std::size_t{0}, half)})
          kernels->merge_nearest(0.5F, -0.25F,
                                 {x.data() + begin, y.data() + begin, index.data() + begin, end - begin},
                                 {nearest.data(), blocks});
        EXPECT_EQ(nearest, expected) << count << " points in " << blocks;
      }
  }
}

}  // namespace
}  // namespace psi_slam
