// SPDX-License-Identifier: BSD-3-Clause
// Genetic searches of a window for the best pose of equation 1.
#pragma once

#include <vector>

#include "matching/genetic_operators.h"
#include "matching/genetic_options.h"
#include "matching/tile_space.h"
#include "matching/window_matcher.h"

namespace psi_slam {

/// The genetic algorithm of the paper, exactly (section 3.1): binary chromosomes of equations 9, 10 and 12,
/// the response of equation 11 as fitness, roulette wheel, two-point crossover, bit-flip mutation, each
/// generation replacing the last. Returns the best pose of all generations.
FoundPeaks paper_genetic_search(const SearchLattice& lattice, const PeakRequest& request,
                                const PaperGeneticOptions& options);

/// A genetic algorithm with local search, which copes with a rugged response. MemeticGeneticOptions switches
/// each of its ideas: Gray code, a first generation from a sparse coarse search, fitness on the max-pooled
/// grid first, elitism, niches, local descent, and a stop when the best no longer improves. Its individuals
/// are tiles. Throws std::invalid_argument if the lattice's grid has no pyramid, unless the window is one
/// tile.
FoundPeaks memetic_search(const SearchLattice& lattice, const PeakRequest& request,
                          const MemeticGeneticOptions& options);

/// The evolution that memetic_search() runs: tiles evolve by selection, crossover and mutation, the best of
/// them descend along the heading, and the best poses are polished exactly. Evolves `first_generation`
/// (random tiles if it is empty), first on the pooled level if `pooled`, then on the finest.
FoundPeaks evolve_tiles(const SearchLattice& lattice, const TileSpace& space,
                        const std::vector<Chromosome>& first_generation, bool pooled,
                        const PeakRequest& request, const MemeticGeneticOptions& options, Random& random);

}  // namespace psi_slam
