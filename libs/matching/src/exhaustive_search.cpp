// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/exhaustive_search.h"

namespace psi_slam {

SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded) {
  const SearchWindow& window = lattice.window();
  const int width = 2 * window.n_x + 1;
  const int height = 2 * window.n_y + 1;
  SearchOutcome outcome;
  Candidate best;
  best.sum = min_sum;
  ShiftSums sums;
  for (int theta = -window.n_theta; theta <= window.n_theta; ++theta) {
    sums.compute(lattice.grid().finest(), lattice.cells(theta), lattice.points(), {-window.n_x, -window.n_y},
                 width, height);
    for (int y = 0; y < height; ++y) {
      const std::uint32_t* row = sums.row(y);
      for (int x = 0; x < width; ++x) {
        if (row[x] < best.sum) continue;
        const Candidate candidate = {row[x], {x - window.n_x, y - window.n_y, theta}};
        if (outcome.best && !candidate.better_than(best)) continue;
        if (excluded && excluded->contains(candidate.pose)) continue;
        best = candidate;
        outcome.best = candidate;
      }
    }
    outcome.evaluations += static_cast<std::int64_t>(width) * height;
  }
  return outcome;
}

}  // namespace psi_slam
