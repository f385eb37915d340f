// SPDX-License-Identifier: BSD-3-Clause
#include "matching/coarse_cells.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

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

}  // namespace

CoarseCells rank_coarse_cells(const SearchLattice& lattice, int heading_stride, int count,
                              std::uint32_t min_sum) {
  if (!lattice.grid().has_pyramid())
    throw std::invalid_argument("coarse cells need the score grid's pyramid");
  const SearchWindow& window = lattice.window();
  const ScoreLevel& level = lattice.grid().pyramid(1);
  const int side = level.stride_cells();
  const int width = (2 * window.n_x + side) / side;
  const int height = (2 * window.n_y + side) / side;
  CoarseCells coarse;
  std::vector<RankedCell> ranked;
  const auto kept_at_most = static_cast<std::size_t>(count);
  ShiftSums sums;
  std::int64_t order = 0;
  for (int theta = -window.n_theta + heading_stride / 2; theta - heading_stride / 2 <= window.n_theta;
       theta += heading_stride) {
    const int turn = std::min(theta, window.n_theta);
    sums.compute(level, lattice.cells(turn), lattice.points(), {-window.n_x, -window.n_y}, width, height);
    coarse.evaluations += static_cast<std::int64_t>(width) * height;
    if (ranked.size() > 4 * kept_at_most) keep_best(ranked, kept_at_most);
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
  keep_best(ranked, kept_at_most);
  std::sort(ranked.begin(), ranked.end(), better);
  for (const RankedCell& one : ranked) coarse.best.push_back(one.cell);
  return coarse;
}

}  // namespace psi_slam
