// SPDX-License-Identifier: BSD-3-Clause
#include "matching/score_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace psi_slam {
namespace {

int ceil_divide(int a, int b) {
  return (a + b - 1) / b;
}

// Returns the maxima over aligned 2 x 2 blocks of cells.
ScoreLevel halved(const ScoreLevel& fine) {
  ScoreLevel blocks(ceil_divide(fine.width(), 2), ceil_divide(fine.height(), 2), 2 * fine.stride_cells());
  for (int y = 0; y < blocks.height(); ++y) {
    // The margin of zeros completes the last blocks.
    const std::uint8_t* low = fine.cell(0, 2 * y);
    const std::uint8_t* high = fine.cell(0, 2 * y + 1);
    std::uint8_t* __restrict row = blocks.cell(0, y);
    for (int x = 0, width = blocks.width(); x < width; ++x)
      row[x] = std::max(std::max(low[2 * x], low[2 * x + 1]), std::max(high[2 * x], high[2 * x + 1]));
  }
  return blocks;
}

// Returns the maxima over 2 x 2 neighbouring blocks. Cells with x or y = -1 lie in the margin. They cover
// points just left of or below the grid, so they include the first blocks.
ScoreLevel overlapping(const ScoreLevel& blocks) {
  ScoreLevel pooled(blocks.width(), blocks.height(), blocks.stride_cells());
  for (int y = -1; y < blocks.height(); ++y) {
    const std::uint8_t* low = blocks.cell(-1, y);
    const std::uint8_t* high = blocks.cell(-1, y + 1);
    std::uint8_t* __restrict cell = pooled.cell(-1, y);
    for (int i = 0, end = blocks.width(); i <= end; ++i)
      cell[i] = std::max(std::max(low[i], low[i + 1]), std::max(high[i], high[i + 1]));
  }
  return pooled;
}

using Four = float __attribute__((vector_size(16)));
using FourBytes = std::uint8_t __attribute__((vector_size(4)));

// Catmull-Rom weights of four neighbouring values and their derivatives, at the position u in [0, 1) between
// the middle two values.
struct CubicWeights {
  Four value;
  Four slope;
};

float dot(const Four& a, const Four& b) {
  const Four product = a * b;
  return (product[0] + product[1]) + (product[2] + product[3]);
}

CubicWeights cubic_weights(float u) {
  constexpr Four kCubic = {-0.5F, 1.5F, -1.5F, 0.5F};
  constexpr Four kSquare = {1.0F, -2.5F, 2.0F, -0.5F};
  constexpr Four kLinear = {-0.5F, 0.0F, 0.5F, 0.0F};
  constexpr Four kConstant = {0.0F, 1.0F, 0.0F, 0.0F};
  return {((kCubic * u + kSquare) * u + kLinear) * u + kConstant,
          (3.0F * kCubic * u + 2.0F * kSquare) * u + kLinear};
}

}  // namespace

ScoreLevel::ScoreLevel(int width, int height, int stride_cells)
    : width_(width),
      height_(height),
      stride_cells_(stride_cells),
      row_bytes_(width + 2 * kMargin),
      bytes_(
          static_cast<std::size_t>(row_bytes_) * static_cast<std::size_t>(height + 2 * kMargin) + kRunPadding,
          0) {}

ScoreGrid::ScoreGrid(double origin_x_m, double origin_y_m, double resolution_m, int width, int height)
    : origin_x_m_(origin_x_m),
      origin_y_m_(origin_y_m),
      resolution_m_(resolution_m),
      finest_(width, height, 1) {}

ScoreGrid ScoreGrid::cropped(int x, int y, int width, int height) const {
  ScoreGrid part(origin_x_m_ + x * resolution_m_, origin_y_m_ + y * resolution_m_, resolution_m_, width,
                 height);
  for (int row = 0; row < height; ++row)
    std::copy_n(finest_.cell(x, y + row), width, part.finest_.cell(0, row));
  return part;
}

void ScoreGrid::build_pyramid() {
  pyramid_.clear();
  ScoreLevel blocks = halved(finest_);
  for (const int stride : kStrides) {
    while (blocks.stride_cells() < stride) blocks = halved(blocks);
    pyramid_.push_back(overlapping(blocks));
  }
}

void ScoreGrid::make_bounds() {
  bounds_.clear();
  for (const int stride : kBoundStrides)
    bounds_.emplace_back(stride, Cell{0, 0}, Cell{finest_.width(), finest_.height()}, kBoundedBlocks,
                         kBoundedBlocks);
}

void ScoreGrid::update_bounds(Cell first, Cell end) {
  for (BoundTables& tables : bounds_) tables.update(finest_, first, end);
}

const BoundTables* ScoreGrid::bounds(int stride_cells, int columns, int rows) const {
  for (const BoundTables& tables : bounds_)
    if (tables.stride_cells() == stride_cells && columns <= tables.layout().columns &&
        rows <= tables.layout().rows)
      return &tables;
  return nullptr;
}

ScoreGrid::Sample ScoreGrid::interpolate(double x_m, double y_m) const {
  const double x = (x_m - origin_x_m_) / resolution_m_ - 0.5;
  const double y = (y_m - origin_y_m_) / resolution_m_ - 0.5;
  const int column = floor_to_int(x);
  const int row = floor_to_int(y);
  if (!finest_.inside(column - 1, row - 1) || !finest_.inside(column + 2, row + 2)) return {0, 0, 0};
  const CubicWeights wx = cubic_weights(static_cast<float>(x - column));
  const CubicWeights wy = cubic_weights(static_cast<float>(y - row));
  Four across = {};  // weighted sums over the rows, one per column
  Four across_slope = {};
  for (int j = 0; j < 4; ++j) {
    FourBytes bytes;
    std::memcpy(&bytes, finest_.cell(column - 1, row - 1 + j), sizeof bytes);
    const Four scores = __builtin_convertvector(bytes, Four);
    across += wy.value[j] * scores;
    across_slope += wy.slope[j] * scores;
  }
  const float value = dot(across, wx.value);
  const float d_dx = dot(across, wx.slope);
  const float d_dy = dot(across_slope, wx.value);
  const double per_metre = 1.0 / (255.0 * resolution_m_);
  return {static_cast<double>(value) / 255.0, static_cast<double>(d_dx) * per_metre,
          static_cast<double>(d_dy) * per_metre};
}

std::size_t ScoreGrid::memory_bytes() const {
  std::size_t bytes = finest_.memory_bytes();
  for (const ScoreLevel& level : pyramid_) bytes += level.memory_bytes();
  for (const BoundTables& tables : bounds_) bytes += tables.memory_bytes();
  return bytes;
}

}  // namespace psi_slam
