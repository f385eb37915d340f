// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/obstacle_field.h"

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

// Two sweeps over the map carry the distances from cell to cell.
void ObstacleField::measure_distances(std::ptrdiff_t width, std::ptrdiff_t height) {
  const auto update = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t step) {
    std::uint8_t& cell = distances_[static_cast<std::size_t>(y * width + x)];
    int nearest = cell;
    const auto look = [&](std::ptrdiff_t at_x, std::ptrdiff_t at_y) {
      if (at_x < 0 || at_x >= width || at_y < 0 || at_y >= height) return;
      nearest = std::min(nearest, 1 + distances_[static_cast<std::size_t>(at_y * width + at_x)]);
    };
    look(x - step, y);
    for (std::ptrdiff_t at_x = x - 1; at_x <= x + 1; ++at_x) look(at_x, y - step);
    cell = static_cast<std::uint8_t>(nearest);
  };
  for (std::ptrdiff_t y = 0; y < height; ++y)
    for (std::ptrdiff_t x = 0; x < width; ++x) update(x, y, 1);
  for (std::ptrdiff_t y = height - 1; y >= 0; --y)
    for (std::ptrdiff_t x = width - 1; x >= 0; --x) update(x, y, -1);
}

}  // namespace psi_slam
