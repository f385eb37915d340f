// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/score_grid.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

int ceil_divide(int a, int b) {
  return (a + b - 1) / b;
}

// The maximum over aligned stride x stride blocks of `fine`, then over two neighbouring blocks a side.
ScoreLevel pool(const ScoreLevel& fine, int stride) {
  const int blocks_x = ceil_divide(fine.width(), stride);
  const int blocks_y = ceil_divide(fine.height(), stride);
  ScoreLevel blocks(blocks_x, blocks_y, stride);
  for (int y = 0; y < fine.height(); ++y) {
    const std::uint8_t* row = fine.cell(0, y);
    std::uint8_t* block = blocks.cell(0, y / stride);
    for (int x = 0; x < fine.width(); ++x) block[x / stride] = std::max(block[x / stride], row[x]);
  }
  // In the margin, cell -1 too sees the first block: it stands for points just left of or below the grid.
  ScoreLevel pooled(blocks_x, blocks_y, stride);
  for (int y = -1; y < blocks_y; ++y)
    for (int x = -1; x < blocks_x; ++x)
      *pooled.cell(x, y) =
          std::max({blocks.at(x, y), blocks.at(x + 1, y), blocks.at(x, y + 1), blocks.at(x + 1, y + 1)});
  return pooled;
}

// Catmull-Rom weights of the four neighbours for u in [0, 1) between the middle two, and their derivatives.
struct CubicWeights {
  std::array<float, 4> value;
  std::array<float, 4> slope;
};

CubicWeights cubic_weights(float u) {
  const float u2 = u * u;
  const float u3 = u2 * u;
  return {{0.5F * (-u3 + 2 * u2 - u), 0.5F * (3 * u3 - 5 * u2 + 2), 0.5F * (-3 * u3 + 4 * u2 + u),
           0.5F * (u3 - u2)},
          {0.5F * (-3 * u2 + 4 * u - 1), 0.5F * (9 * u2 - 10 * u), 0.5F * (-9 * u2 + 8 * u + 1),
           0.5F * (3 * u2 - 2 * u)}};
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
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  if (!finest_.inside(column - 1, row - 1) || !finest_.inside(column + 2, row + 2)) return {0, 0, 0};
  const CubicWeights wx = cubic_weights(static_cast<float>(x - column));
  const CubicWeights wy = cubic_weights(static_cast<float>(y - row));
  float value = 0;
  float d_dx = 0;
  float d_dy = 0;
  for (int j = 0; j < 4; ++j) {
    const std::uint8_t* cell = finest_.cell(column - 1, row - 1 + j);
    float row_value = 0;
    float row_slope = 0;
    for (int i = 0; i < 4; ++i) {
      const auto score = static_cast<float>(cell[i]);
      row_value += wx.value[i] * score;
      row_slope += wx.slope[i] * score;
    }
    value += wy.value[j] * row_value;
    d_dx += wy.value[j] * row_slope;
    d_dy += wy.slope[j] * row_value;
  }
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
