// SPDX-License-Identifier: BSD-3-Clause
// Converts occupancy to scores, M of equation 1. The evidence of a cell grows from 0 at an occupancy
// probability of 0.5 to 1 at 0.65. Free and unknown cells have no evidence, so unobserved space attracts no
// scans. A Gaussian with the standard deviation of the range noise spreads the evidence. A straight wall, one
// cell thick, scores 1 at its middle.
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

  /// Returns the evidence of a cell of the occupancy grid, 0 .. 255.
  std::uint8_t evidence(mrpt::maps::COccupancyGridMap2D::cellType cell) const {
    return evidence_[static_cast<std::uint8_t>(cell)];
  }

  /// Distance in cells over which the evidence of a cell is spread.
  int reach_cells() const { return reach_; }

  /// Computes the cells [x, x_end) x [y, y_end) of `scores` from the cells of `grid` in this region and
  /// within reach_cells() of it.
  void paint(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y, int x_end, int y_end,
             ScoreLevel& scores);

 private:
  int reach_;
  std::vector<std::uint16_t> kernel_;       // weights of (2 reach + 1)^2 cells; 256 is weight 1
  std::array<std::uint8_t, 256> evidence_;  // 0 .. 255 for each raw cell value, cast to std::uint8_t
  std::vector<std::uint16_t> sums_;
};

}  // namespace psi_slam
