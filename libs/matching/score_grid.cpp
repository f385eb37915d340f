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

// Writes the maxima of pairs of cells. The result must not overlap the cells, so that the compiler vectorises
// the loop.
void halve(const std::uint8_t* cells, std::size_t pairs, std::uint8_t* __restrict maxima) {
  for (std::size_t i = 0; i < pairs; ++i) maxima[i] = std::max(cells[2 * i], cells[2 * i + 1]);
}

// Returns a pyramid level: maxima over aligned stride x stride blocks of `fine`, then over 2 x 2 neighbouring
// blocks. The stride is a power of two.
ScoreLevel pool(const ScoreLevel& fine, int stride) {
  const int blocks_x = ceil_divide(fine.width(), stride);
  const int blocks_y = ceil_divide(fine.height(), stride);
  ScoreLevel blocks(blocks_x, blocks_y, stride);
  const auto padded = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(stride);
  std::vector<std::uint8_t> highest(padded);  // cells of a row of blocks, then maxima over 2, 4, ... of them
  std::vector<std::uint8_t> halves(padded);
  for (int row = 0; row < blocks_y; ++row) {
    std::fill(highest.begin(), highest.end(), std::uint8_t{0});
    for (int y = row * stride; y < std::min((row + 1) * stride, fine.height()); ++y)
      std::transform(fine.cell(0, y), fine.cell(0, y) + fine.width(), highest.begin(), highest.begin(),
                     [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
    std::size_t cells = padded;
    for (int width = 1; width < stride; width *= 2) {
      cells /= 2;
      halve(highest.data(), cells, halves.data());
      highest.swap(halves);
    }
    std::copy_n(highest.begin(), cells, blocks.cell(0, row));
  }
  // Cells with x or y = -1 lie in the margin. They cover points just left of or below the grid, so they
  // include the first blocks.
  ScoreLevel pooled(blocks_x, blocks_y, stride);
  for (int y = -1; y < blocks_y; ++y) {
    const std::uint8_t* low = blocks.cell(-1, y);
    const std::uint8_t* high = blocks.cell(-1, y + 1);
    std::uint8_t* cell = pooled.cell(-1, y);
    for (int i = 0; i <= blocks_x; ++i)
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
  for (const int stride : kStrides) pyramid_.push_back(pool(finest_, stride));
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
  return bytes;
}

}  // namespace psi_slam
