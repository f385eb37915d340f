// SPDX-License-Identifier: BSD-3-Clause
#include "matching/memetic_search.h"

#include <stdexcept>

#include "matching/coarse_seeds.h"
#include "matching/tile_evolution.h"

namespace psi_slam {

FoundPeaks memetic_search(const SearchLattice& lattice, const PeakRequest& request,
                          const MemeticGeneticOptions& options) {
  const WindowTiles tiles(lattice.window(), options.gray_code);
  const bool one_block = tiles.columns() * tiles.rows() == 1;
  if (!one_block && !lattice.grid().has_pyramid())
    throw std::invalid_argument("the memetic search needs the score grid's pyramid");
  Random random = random_for(request.seed);
  Seeds seeds;
  if (options.seed_coarse) seeds = coarse_seeds(lattice, tiles, options, random);
  FoundPeaks peaks =
      evolve_tiles(lattice, tiles, seeds.chromosomes, options.pooled_fitness && lattice.grid().has_pyramid(),
                   request, options, random);
  peaks.evaluations += seeds.evaluations;
  return peaks;
}

}  // namespace psi_slam
