// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/coarse_to_genetic_matcher.h"

#include "psi_slam/matching/coarse_cells.h"
#include "psi_slam/matching/memetic_search.h"
#include "psi_slam/matching/tile_evolution.h"

namespace psi_slam {

FoundPeaks CoarseToGeneticMatcher::find_peaks(const SearchLattice& lattice,
                                              const PeakRequest& request) const {
  const WindowTiles tiles(lattice.window(), genetic_.gray_code);
  if (tiles.columns() * tiles.rows() == 1) return memetic_search(lattice, request, genetic_);
  const CoarseCells coarse =

      rank_coarse_cells(lattice, genetic_.heading_stride, coarse_.cells, request.min_sum);
  FoundPeaks peaks;
  if (!coarse.best.empty()) {
    const CellTiles space(lattice.window(), coarse.best, genetic_.heading_stride, genetic_.gray_code);
    std::vector<Chromosome> first_generation;
    for (std::size_t cell = 0; cell < coarse.best.size(); ++cell)
      first_generation.push_back(space.encode(cell));
    Random random = random_for(request.seed);
    peaks =
        evolve_tiles(lattice, space, first_generation, genetic_.pooled_fitness, request, genetic_, random);
  }
  peaks.evaluations += coarse.evaluations;
  return peaks;
}

}  // namespace psi_slam
