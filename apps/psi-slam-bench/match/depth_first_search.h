// SPDX-License-Identifier: BSD-3-Clause
// The depth-first branch and bound of Hess et al., "Real-time loop closure in 2D lidar SLAM", ICRA 2016,
// section V, in plain scalar code. The benchmark measures the exact search of psi-slam against it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "matching/search_lattice.h"

namespace psi_slam {

/// Grids of maxima, as large as the score grid. Cell (x, y) of level h holds the largest score among the
/// finest cells [x, x + 2^h) x [y, y + 2^h).
class MaximumGrids {
 public:
  static constexpr int kLevels = 7;  ///< as in Cartographer's default settings

  explicit MaximumGrids(const ScoreGrid& grid);

  /// Returns the maximum of a cell of the level; 0 if it has no finest cell inside the grid.
  std::uint8_t at(int level, int x, int y) const;

 private:
  struct Level {
    int margin = 0;  ///< number of cells below cell 0 along each axis
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> cells;
  };

  static std::uint8_t cell(const Level& level, int x, int y);

  std::vector<Level> levels_;
};

struct DepthFirstOutcome {
  std::optional<Candidate> best;  ///< empty if no pose reaches the smallest sum
  std::int64_t evaluations = 0;   ///< number of nodes scored, on all levels
};

/// Finds the same pose as exhaustive_search(). `grids` must be those of the lattice's score grid.
DepthFirstOutcome depth_first_search(const SearchLattice& lattice, const MaximumGrids& grids,
                                     std::uint32_t min_sum);

}  // namespace psi_slam
