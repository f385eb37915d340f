// SPDX-License-Identifier: BSD-3-Clause
// The fitness of the memetic search: tiles scored on one level of the score grid.
#pragma once

#include <cstdint>

#include "matching/tile_space.h"

namespace psi_slam {

enum class TileLevel {
  kPooled,  ///< an upper bound of the tile's poses, from the first level of the grid's pyramid
  kFinest,  ///< the tile's best pose
};

/// Scores tiles on a lattice.
class TileScorer {
 public:
  explicit TileScorer(const SearchLattice& lattice) : lattice_(lattice) {}

  /// The best sum of the tile and the pose that has it; on the pooled level, the first pose of the block.
  Candidate score(const Tile& tile, TileLevel level);

  /// The best of the 16 x 16 poses around one, -8 .. 7 shifts away, at the same heading, which must be of the
  /// window.
  Candidate best_near(const LatticePose& pose);

  std::int64_t evaluations() const { return evaluations_; }

 private:
  const SearchLattice& lattice_;
  ShiftSums sums_;
  std::int64_t evaluations_ = 0;
};

}  // namespace psi_slam
