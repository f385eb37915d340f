// SPDX-License-Identifier: BSD-3-Clause
#include "matching/coarse_search.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace psi_slam {
namespace {

struct RankedCell {
  std::uint32_t sum;
  std::int64_t order;
  Tile cell;
};

bool better(const RankedCell& a, const RankedCell& b) {
  return std::tie(b.sum, a.order) < std::tie(a.sum, b.order);
}

void keep_best(std::vector<RankedCell>& ranked, std::size_t count) {
  if (ranked.size() <= count) return;
  std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), ranked.end(), better);
  ranked.resize(count);
}

// The best coarse sum of each tile, at each heading that was summed.
class TileSums {
 public:
  TileSums(int turns, const WindowTiles& tiles)
      : turns_(turns), rows_(tiles.rows()), columns_(tiles.columns()), sums_(index(turns, 0, 0), 0) {}

  std::uint32_t& at(int turn, int row, int column) { return sums_[index(turn, row, column)]; }

  // Returns whether no neighbour has a larger sum. Neighbours differ by at most 1 in turn, row and column.
  bool is_peak(int turn, int row, int column) {
    const std::uint32_t here = at(turn, row, column);
    for (int t = std::max(0, turn - 1); t <= std::min(turns_ - 1, turn + 1); ++t)
      for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
        for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c)
          if (at(t, r, c) > here) return false;
    return true;
  }

  // Returns the largest sum that more than `count` tiles reach; 0 for at most `count` tiles.
  std::uint32_t reached_by(std::size_t count) const {
    if (count >= sums_.size()) return 0;
    std::vector<std::uint32_t> sums = sums_;
    const auto last = sums.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(sums.begin(), last, sums.end(), std::greater<>());
    return *last;
  }

 private:
  std::size_t index(int turn, int row, int column) const {
    return (static_cast<std::size_t>(turn) * static_cast<std::size_t>(rows_) +
            static_cast<std::size_t>(row)) *
               static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int turns_;
  int rows_;
  int columns_;
  std::vector<std::uint32_t> sums_;
};

}  // namespace

CoarseCells rank_coarse_cells(const SearchLattice& lattice, std::size_t count, std::uint32_t min_sum) {
  if (!lattice.grid().has_pyramid())
    throw std::invalid_argument("coarse cells need the score grid's pyramid");
  const SearchWindow& window = lattice.window();
  const ScoreLevel& level = lattice.grid().pyramid(1);
  const int side = level.stride_cells();
  const int width = (2 * window.n_x + side) / side;
  const int height = (2 * window.n_y + side) / side;
  CoarseCells coarse;
  std::vector<RankedCell> ranked;
  ShiftSums sums;
  std::int64_t order = 0;
  for (int theta = -window.n_theta + kHeadingStride / 2; theta - kHeadingStride / 2 <= window.n_theta;
       theta += kHeadingStride) {
    const int turn = std::min(theta, window.n_theta);
    sums.compute(level, lattice.cells(turn), lattice.points(), {-window.n_x, -window.n_y}, width, height);
    coarse.evaluations += static_cast<std::int64_t>(width) * height;
    if (ranked.size() > 4 * count) keep_best(ranked, count);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x, ++order) {
        if (sums.row(y)[x] < min_sum) continue;
        const Cell first = {x * side - window.n_x, y * side - window.n_y};
        ranked.push_back(
            {sums.row(y)[x],
             order,
             {turn,
              {first, std::min(side, window.n_x + 1 - first.x), std::min(side, window.n_y + 1 - first.y)}}});
      }
    }
  }
  keep_best(ranked, count);
  std::sort(ranked.begin(), ranked.end(), better);
  for (const RankedCell& one : ranked) coarse.best.push_back(one.cell);
  return coarse;
}

Seeds coarse_seeds(const SearchLattice& lattice, const WindowTiles& tiles,
                   const MemeticGeneticOptions& options, Random& random) {
  const SearchWindow& window = lattice.window();
  const int first = static_cast<int>(draw_below(
                        static_cast<std::uint64_t>(std::min(kHeadingStride, tiles.turns())), random)) -
                    window.n_theta;
  Seeds seeds;
  if (tiles.columns() * tiles.rows() == 1) {
    for (int theta = first; theta <= window.n_theta; theta += kHeadingStride)
      seeds.chromosomes.push_back(tiles.encode(theta, 0, 0));
    return seeds;
  }

  const ScoreLevel& level = lattice.grid().pyramid(1);
  const int block = level.stride_cells();
  const int width = (2 * window.n_x + block) / block;
  const int height = (2 * window.n_y + block) / block;
  const std::size_t every =
      std::max<std::size_t>(1, lattice.points() / static_cast<std::size_t>(options.seed_points));
  const std::size_t from = draw_below(every, random);
  const int turns = (window.n_theta - first) / kHeadingStride + 1;
  TileSums best(turns, tiles);
  std::vector<Cell> cells;
  ShiftSums sums;
  for (int turn = 0; turn < turns; ++turn) {
    const Cell* all = lattice.cells(first + turn * kHeadingStride);
    cells.clear();
    for (std::size_t p = from; p < lattice.points(); p += every) cells.push_back(all[p]);
    sums.compute(level, cells.data(), cells.size(), {-window.n_x, -window.n_y}, width, height);
    for (int y = 0; y < height; ++y) {
      const int row = tiles.row_of(y * block - window.n_y);
      for (int x = 0; x < width; ++x) {
        std::uint32_t& sum = best.at(turn, row, tiles.column_of(x * block - window.n_x));
        sum = std::max(sum, sums.row(y)[x]);
      }
    }
    seeds.evaluations += static_cast<std::int64_t>(width) * height;
  }

  const auto count = static_cast<std::size_t>(options.seeds);
  const std::uint32_t least = best.reached_by(3 * count);  // more than `count`, because not all are peaks
  std::vector<std::pair<std::uint32_t, Chromosome>> peaks;
  for (int turn = 0; turn < turns; ++turn)
    for (int row = 0; row < tiles.rows(); ++row)
      for (int column = 0; column < tiles.columns(); ++column)
        if (best.at(turn, row, column) >= least && best.is_peak(turn, row, column))
          peaks.emplace_back(best.at(turn, row, column),
                             tiles.encode(first + turn * kHeadingStride, column, row));
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  peaks.resize(std::min(peaks.size(), count));
  for (const auto& [sum, chromosome] : peaks) seeds.chromosomes.push_back(chromosome);
  return seeds;
}

}  // namespace psi_slam
