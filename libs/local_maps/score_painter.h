// SPDX-License-Identifier: BSD-3-Clause
// Converts occupancy to scores, M of equation 1. The evidence of a cell is its occupancy above "unknown".
// Free and unknown cells have none, so that unobserved space attracts no scans. A Gaussian of the size of the
// range noise spreads the evidence; a straight wall one cell thick scores 1 at its middle.
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

  /// Number of cells that the evidence of a cell reaches.
  int reach_cells() const { return reach_; }

  /// Repaints the cells [x, x_end) x [y, y_end) of `scores` from the cells of `grid` there and around.
  void paint(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y, int x_end, int y_end,
             ScoreLevel& scores);

 private:
  int reach_;
  std::vector<std::uint16_t> kernel_;       // (2 reach + 1)^2, 256 is 1
  std::array<std::uint8_t, 256> evidence_;  // indexed by the raw value of a cell, as unsigned
  std::vector<std::uint16_t> sums_;
};

}  // namespace psi_slam
