// SPDX-License-Identifier: BSD-3-Clause
// The first generation of the memetic search: a sparse look at the whole window. Every few headings, from a
// random one on, a share of the scan's points is summed on the coarsest level of the pyramid; the tiles that
// are better than their neighbours are the seeds.
#pragma once

#include <cstdint>
#include <vector>

#include "matching/genetic_operators.h"
#include "matching/genetic_options.h"
#include "matching/tile_space.h"

namespace psi_slam {

struct Seeds {
  std::vector<Chromosome> chromosomes;  ///< the most promising first
  std::int64_t evaluations = 0;
};

/// At most `options.seeds` tiles; every `options.heading_stride`-th heading of a window of one block.
Seeds coarse_seeds(const SearchLattice& lattice, const WindowTiles& tiles,
                   const MemeticGeneticOptions& options, Random& random);

}  // namespace psi_slam
