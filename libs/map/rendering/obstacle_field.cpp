// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/obstacle_field.h"

#include <algorithm>
#include <limits>

namespace psi_slam {

ObstacleField::ObstacleField(const mrpt::maps::COccupancyGridMap2D& grid) {
  const std::size_t width = grid.getSizeX();
  const std::size_t height = grid.getSizeY();
  distances_.assign(width * height, std::numeric_limits<std::uint8_t>::max());
  for (std::size_t y = 0; y < height; ++y) {
    const auto* row = grid.getRow(static_cast<int>(y));
    for (std::size_t x = 0; x < width; ++x)
      if (row[x] < 0) distances_[y * width + x] = 0;
  }
  std::uint32_t occupied = 0;
  for (std::size_t cell = 0; cell < distances_.size(); ++cell) {
    if (cell % kBlock == 0) first_of_block_.push_back(occupied);
    occupied += distances_[cell] == 0 ? 1U : 0U;
  }
  measure_distances(static_cast<std::ptrdiff_t>(width), static_cast<std::ptrdiff_t>(height));
}

// Two sweeps over the map carry the distances from row to row, and along each row.
void ObstacleField::measure_distances(std::ptrdiff_t width, std::ptrdiff_t height) {
  const auto row_at = [&](std::ptrdiff_t y) { return distances_.data() + y * width; };
  const auto lower = [](std::uint8_t& cell, std::uint8_t other) {
    cell = static_cast<std::uint8_t>(std::min<int>(cell, other + 1));
  };
  // Lowers the distances of a row by those of the row beside it.
  const auto lower_by_row = [&](std::uint8_t* row, const std::uint8_t* beside) {
    for (std::ptrdiff_t x = 0; x < width; ++x) lower(row[x], beside[x]);
    for (std::ptrdiff_t x = 1; x < width; ++x) lower(row[x], beside[x - 1]);
    for (std::ptrdiff_t x = 1; x < width; ++x) lower(row[x - 1], beside[x]);
  };
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    if (y > 0) lower_by_row(row_at(y), row_at(y - 1));
    for (std::ptrdiff_t x = 1; x < width; ++x) lower(row_at(y)[x], row_at(y)[x - 1]);
  }
  for (std::ptrdiff_t y = height - 1; y >= 0; --y) {
    if (y + 1 < height) lower_by_row(row_at(y), row_at(y + 1));
    for (std::ptrdiff_t x = width - 1; x > 0; --x) lower(row_at(y)[x - 1], row_at(y)[x]);
  }
}

}  // namespace psi_slam
