// SPDX-License-Identifier: BSD-3-Clause
#include "matching/coarse_to_genetic_matcher.h"

#include <algorithm>
#include <cstdlib>

#include "matching/coarse_cells.h"
#include "matching/exact_search.h"
#include "matching/memetic_search.h"
#include "matching/paper_genetic_search.h"
#include "matching/tile_evolution.h"
#include "matching/tile_scorer.h"

namespace psi_slam {
namespace {

FoundPeaks evolve_cells(const SearchLattice& lattice, const std::vector<Tile>& cells,
                        const PeakRequest& request, const MemeticGeneticOptions& options) {
  const CellTiles space(lattice.window(), cells, options.heading_stride, options.gray_code);
  std::vector<Chromosome> first_generation;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) first_generation.push_back(space.encode(cell));
  Random random = random_for(request.seed);
  return evolve_tiles(lattice, space, first_generation, options.pooled_fitness, request, options, random);
}

// As the paper has it: in each of the best cells, a small window of its own, a genetic search with
// chromosomes of equation 10 for that window. A quarter of the cell's poses are scored: else trying all would
// be cheaper.
FoundPeaks search_cells_as_in_the_paper(const SearchLattice& lattice, const std::vector<Tile>& cells,
                                        int heading_stride, const PeakRequest& request,
                                        const PaperGeneticOptions& options) {
  constexpr std::size_t kCells = 32;
  constexpr int kGenerations = 4;
  SearchWindow window = lattice.window();
  window.n_x = window.n_y = 4;
  window.n_theta = std::max(1, heading_stride / 2);
  PaperGeneticOptions in_cell = options;
  in_cell.generations = kGenerations;
  in_cell.population = 2 * window.n_x * window.n_y * window.n_theta / kGenerations;

  TileScorer scorer(lattice);
  std::vector<Candidate> best_of_cells;
  FoundPeaks peaks;
  for (std::size_t i = 0; i < std::min(cells.size(), kCells); ++i) {
    const LatticePose centre = {cells[i].block.first.x + window.n_x, cells[i].block.first.y + window.n_y,
                                cells[i].theta};
    const SearchLattice cell(lattice.grid(), lattice.scan(), lattice.pose(centre), window);
    PeakRequest in_this_cell;
    in_this_cell.seed = request.seed;
    in_this_cell.seed.run ^= (static_cast<std::uint64_t>(i) + 1) << 32;
    const FoundPeaks found = paper_genetic_search(cell, in_this_cell, in_cell);
    peaks.evaluations += found.evaluations;
    peaks.genetic.generations += found.genetic.generations;
    peaks.genetic.decoded += found.genetic.decoded;
    peaks.genetic.repaired += found.genetic.repaired;
    const LatticePose pose = {centre.x + found.best->pose.x, centre.y + found.best->pose.y,
                              centre.theta + found.best->pose.theta};
    const SearchWindow& whole = lattice.window();
    if (std::abs(pose.x) > whole.n_x || std::abs(pose.y) > whole.n_y || std::abs(pose.theta) > whole.n_theta)
      continue;
    best_of_cells.push_back(scorer.score({pose.theta, {{pose.x, pose.y}, 1, 1}}, TileLevel::kFinest));
  }
  peaks.evaluations += scorer.evaluations();
  pick_peaks(best_of_cells, request, peaks);
  return peaks;
}

}  // namespace

FoundPeaks CoarseToGeneticMatcher::search(const SearchLattice& lattice, const PeakRequest& request) const {
  const MemeticGeneticOptions& memetic = genetic_.memetic;
  const bool as_in_the_paper = genetic_.variant == GeneticVariant::kPaper;
  const WindowTiles tiles(lattice.window(), memetic.gray_code);
  if (!as_in_the_paper && tiles.columns() * tiles.rows() == 1)
    return memetic_search(lattice, request, memetic);
  const CoarseCells coarse =
      rank_coarse_cells(lattice, memetic.heading_stride, genetic_.coarse.cells, request.min_sum);
  FoundPeaks peaks;
  if (!coarse.best.empty()) {
    peaks = as_in_the_paper ? search_cells_as_in_the_paper(lattice, coarse.best, memetic.heading_stride,
                                                           request, genetic_.paper)
                            : evolve_cells(lattice, coarse.best, request, memetic);
  }
  peaks.evaluations += coarse.evaluations;
  return peaks;
}

FoundPeaks CoarseToGeneticMatcher::find_peaks(const SearchLattice& lattice,
                                              const PeakRequest& request) const {
  FoundPeaks peaks = search(lattice, request);
  if (needs_exact_next(lattice.window())) find_next_exactly(lattice, request, peaks);
  return peaks;
}

}  // namespace psi_slam
