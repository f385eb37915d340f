// SPDX-License-Identifier: BSD-3-Clause
// Genetic searches of a window for the best pose of equation 1.
#pragma once

#include <vector>

#include "matching/genetic_operators.h"
#include "matching/genetic_options.h"
#include "matching/tile_space.h"
#include "matching/window_matcher.h"

namespace psi_slam {

/// Runs the genetic algorithm exactly as in the paper (section 3.1). Chromosomes are binary (equations 9, 10
/// and 12), and the fitness is the response of equation 11. The operators are roulette wheel, two-point
/// crossover and bit-flip mutation. Each generation replaces the generation before it. Returns the best pose
/// of all generations.
FoundPeaks paper_genetic_search(const SearchLattice& lattice, const PeakRequest& request,
                                const PaperGeneticOptions& options);

/// Runs a genetic algorithm with local search, for responses with many local maxima. Its individuals are
/// tiles. A sparse coarse search finds the first generation. Throws std::invalid_argument if the lattice's
/// grid has no pyramid, unless the window is one tile.
FoundPeaks memetic_search(const SearchLattice& lattice, const PeakRequest& request,
                          const MemeticGeneticOptions& options);

/// Runs the evolution of memetic_search() from a first generation, which must not be empty. Tiles evolve by
/// selection, crossover and mutation, first on the pooled level of the grid and then on the finest. Each
/// generation keeps its best tiles, at most one in each neighbourhood, so that several peaks survive. A local
/// search along the heading improves the best tiles. An exact search around the best poses ends the
/// evolution.
FoundPeaks evolve_tiles(const SearchLattice& lattice, const TileSpace& space,
                        const std::vector<Chromosome>& first_generation, const PeakRequest& request,
                        const MemeticGeneticOptions& options, Random& random);

}  // namespace psi_slam
