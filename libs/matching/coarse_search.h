// SPDX-License-Identifier: BSD-3-Clause
// Searches a whole window coarsely, on the coarsest level of the score grid's pyramid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "matching/genetic_operators.h"
#include "matching/genetic_options.h"
#include "matching/tile_space.h"

namespace psi_slam {

struct CoarseCells {
  std::vector<Tile> best;  ///< best cells, in descending order of sums; `theta` is the middle heading
  std::int64_t evaluations = 0;
};

/// The coarse stage of multi-resolution correlative matching (Olson 2009): sums all points for every block of
/// the coarsest level and every kHeadingStride-th heading. Returns the `count` best cells that reach
/// `min_sum`; of equal cells, the first ones. Throws std::invalid_argument if the lattice's grid has no
/// pyramid.
CoarseCells rank_coarse_cells(const SearchLattice& lattice, std::size_t count, std::uint32_t min_sum);

struct Seeds {
  std::vector<Chromosome> chromosomes;  ///< codes of the tiles, in descending order of sums
  std::int64_t evaluations = 0;
};

/// Returns the first generation of the memetic search. Sums a part of the scan's points at every
/// kHeadingStride-th heading, beginning at a random heading. Returns at least one tile, and at most
/// `options.seeds`, whose sum no neighbouring tile exceeds. For a window of one block, returns the tiles of
/// all these headings without sums. For other windows, the grid must have a pyramid.
Seeds coarse_seeds(const SearchLattice& lattice, const WindowTiles& tiles,
                   const MemeticGeneticOptions& options, Random& random);

}  // namespace psi_slam
