// SPDX-License-Identifier: BSD-3-Clause
// From occupancy to scores: M of equation 1. A cell's evidence is how far its occupancy lies above "unknown";
// free and unknown cells have none, so that scans are not drawn into places nobody has seen. A Gaussian of
// the size of the range noise spreads it, normalised so that the middle of a straight wall one cell thick
// scores 1.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <array>
#include <cstdint>
#include <vector>

#include "matching/score_grid.h"

namespace psi_slam {

class ScorePainter {
 public:
  ScorePainter(double sigma_m, double resolution_m);

  /// How many cells a cell's evidence reaches.
  int reach_cells() const { return reach_; }

  /// Repaints the cells [x, x_end) x [y, y_end) of `scores` from the same cells of `grid` and their
  /// surroundings.
  void paint(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y, int x_end, int y_end,
             ScoreLevel& scores);

 private:
  int reach_;
  std::vector<std::uint16_t> kernel_;       // (2 reach + 1)^2, 256 is 1
  std::array<std::uint8_t, 256> evidence_;  // by the cell's raw value, as an unsigned index
  std::vector<std::uint16_t> sums_;
};

}  // namespace psi_slam
