// SPDX-License-Identifier: BSD-3-Clause
// The memetic algorithm itself: tiles evolve by selection, crossover and mutation, the best of them descend
// along the heading, and the best poses are polished exactly.
#pragma once

#include <vector>

#include "matching/genetic_operators.h"
#include "matching/genetic_options.h"
#include "matching/tile_space.h"
#include "matching/window_matcher.h"

namespace psi_slam {

/// Evolves `first_generation`, random tiles where it is empty: first on the pooled level when `pooled`, then
/// on the finest.
FoundPeaks evolve_tiles(const SearchLattice& lattice, const TileSpace& space,
                        const std::vector<Chromosome>& first_generation, bool pooled,
                        const PeakRequest& request, const MemeticGeneticOptions& options, Random& random);

}  // namespace psi_slam
