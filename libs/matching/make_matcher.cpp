// SPDX-License-Identifier: BSD-3-Clause
#include "matching/make_matcher.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "matching/coarse_search.h"
#include "matching/exact_search.h"
#include "matching/genetic_search.h"

namespace psi_slam {
namespace {

constexpr std::size_t kCoarseCells = 2048;  // number of best coarse cells that csm_ga searches genetically

FoundPeaks evolve_cells(const SearchLattice& lattice, const std::vector<Tile>& cells,
                        const PeakRequest& request, const MemeticGeneticOptions& options) {
  const CellTiles space(lattice.window(), cells);
  std::vector<Chromosome> first_generation;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) first_generation.push_back(space.encode(cell));
  Random random = random_for(request.seed);
  return evolve_tiles(lattice, space, first_generation, request, options, random);
}

// Returns `genetic` if the search ran generations, and `without` otherwise.
SearchKind search_of(int generations, SearchKind genetic, SearchKind without) {
  return generations > 0 ? genetic : without;
}

// The paper's variant of csm_ga: runs a genetic search in each of the best cells. The chromosomes of equation
// 10 cover the small window of a cell. Each search scores a quarter as many poses as the cell has. With many
// more, an exhaustive search would be cheaper.
FoundPeaks search_cells_by_paper(const SearchLattice& lattice, const std::vector<Tile>& cells,
                                 const PeakRequest& request, const PaperGeneticOptions& options) {
  constexpr std::size_t kCells = 32;
  constexpr int kGenerations = 4;
  SearchWindow window = lattice.window();
  window.n_x = window.n_y = 4;
  window.n_theta = kHeadingStride / 2;
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
    peaks.generations += found.generations;
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

// Matcher ga: searches the window by a genetic algorithm on binary chromosomes (see GeneticVariant).
class GeneticMatcher : public WindowMatcher {
 public:
  GeneticMatcher(const MatcherOptions& options, const GeneticOptions& genetic)
      : WindowMatcher(options), genetic_(genetic) {}
  std::string name() const override { return "ga"; }

 protected:
  virtual FoundPeaks search(const SearchLattice& lattice, const PeakRequest& request) const {
    FoundPeaks peaks = genetic_.variant == GeneticVariant::kPaper
                           ? paper_genetic_search(lattice, request, genetic_.paper)
                           : memetic_search(lattice, request, genetic_.memetic);
    peaks.search = search_of(peaks.generations, SearchKind::kGenetic, SearchKind::kLocal);
    return peaks;
  }

  GeneticOptions genetic_;

 private:
  FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const override {
    FoundPeaks peaks = search(lattice, request);
    if (needs_exact_next(lattice.window())) ExactSearch(lattice).find_next(request, peaks);
    return peaks;
  }
};

// Matcher csm_ga, the middle mode of the paper (section 3.2). Ranks coarse cells exhaustively, as the coarse
// stage of correlative matching does, then searches the best of them genetically. The paper's variant runs
// the paper's genetic algorithm in each of the best 32 cells. The memetic variant searches a window of one
// block (see WindowTiles) by memetic_search(), because there the coarse stage would rank only headings.
class CoarseToGeneticMatcher : public GeneticMatcher {
 public:
  using GeneticMatcher::GeneticMatcher;
  std::string name() const override { return "csm_ga"; }

 private:
  FoundPeaks search(const SearchLattice& lattice, const PeakRequest& request) const override {
    const bool by_paper = genetic_.variant == GeneticVariant::kPaper;
    const WindowTiles tiles(lattice.window());
    if (!by_paper && tiles.columns() * tiles.rows() == 1) return GeneticMatcher::search(lattice, request);
    const CoarseCells coarse = rank_coarse_cells(lattice, kCoarseCells, request.min_sum);
    FoundPeaks peaks;
    if (!coarse.best.empty())
      peaks = by_paper ? search_cells_by_paper(lattice, coarse.best, request, genetic_.paper)
                       : evolve_cells(lattice, coarse.best, request, genetic_.memetic);
    peaks.search = search_of(peaks.generations, SearchKind::kCoarseGenetic, SearchKind::kCoarse);
    peaks.evaluations += coarse.evaluations;
    return peaks;
  }
};

}  // namespace

FoundPeaks CorrelativeMatcher::find_peaks(const SearchLattice& lattice, const PeakRequest& request) const {
  ExactSearch search(lattice);
  const SearchOutcome outcome = search.find(request.min_sum);
  FoundPeaks peaks;
  peaks.best = outcome.best;
  peaks.search = outcome.search;
  peaks.evaluations = outcome.evaluations;
  search.find_next(request, peaks);
  return peaks;
}

std::unique_ptr<Matcher> make_matcher(MatcherKind kind, const MatcherOptions& options,
                                      const GeneticOptions& genetic) {
  switch (kind) {
    case MatcherKind::kCsm:
      return std::make_unique<CorrelativeMatcher>(options);
    case MatcherKind::kCsmGa:
      return std::make_unique<CoarseToGeneticMatcher>(options, genetic);
    case MatcherKind::kGa:
      return std::make_unique<GeneticMatcher>(options, genetic);
  }
  throw std::invalid_argument("make_matcher: unknown kind of matcher, expected kCsm, kCsmGa or kGa");
}

}  // namespace psi_slam
