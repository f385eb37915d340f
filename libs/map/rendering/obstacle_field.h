// SPDX-License-Identifier: BSD-3-Clause
// The occupied cells of a map, numbered row by row, and the distance of every other cell to the nearest of
// them. Takes a byte and a quarter for each cell of the map.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

class ObstacleField {
 public:
  explicit ObstacleField(const mrpt::maps::COccupancyGridMap2D& grid);

  /// Returns the number of an occupied cell. For other cells, returns minus the distance to the nearest
  /// occupied cell: the number of a king's moves, at most 255. `cell` is row * width + column.
  std::int32_t find(std::size_t cell) const {
    if (distances_[cell] > 0) return -std::int32_t{distances_[cell]};
    std::uint32_t number = first_of_block_[cell / kBlock];
    for (std::size_t other = cell / kBlock * kBlock; other < cell; ++other)
      number += distances_[other] == 0 ? 1U : 0U;
    return static_cast<std::int32_t>(number);
  }

 private:
  static constexpr std::size_t kBlock = 16;

  void measure_distances(std::ptrdiff_t width, std::ptrdiff_t height);

  std::vector<std::uint8_t> distances_;  ///< distance of each cell from the next occupied cell; 0: occupied
  std::vector<std::uint32_t> first_of_block_;  ///< number of occupied cells before each block of cells
};

}  // namespace psi_slam
