// SPDX-License-Identifier: BSD-3-Clause
// The rough stage of multi-resolution correlative matching (Olson 2009): every coarse cell of the window, by
// its sum on the coarsest level of the pyramid.
#pragma once

#include <cstdint>
#include <vector>

#include "matching/tile_space.h"

namespace psi_slam {

struct CoarseCells {
  std::vector<Tile> best;  ///< the best first; each at its middle heading
  std::int64_t evaluations = 0;
};

/// Sums all points for every block of the coarsest level and every `heading_stride`-th heading. Returns the
/// `count` best cells that reach `min_sum`; of equal ones those that come first.
/// Throws std::invalid_argument when the lattice's grid has no pyramid.
CoarseCells rank_coarse_cells(const SearchLattice& lattice, int heading_stride, int count,
                              std::uint32_t min_sum);

}  // namespace psi_slam
