// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exhaustive_search.h"

namespace psi_slam {
namespace {

class Search {
 public:
  Search(const SearchLattice& lattice, std::uint32_t min_sum, const std::optional<ExcludedRegion>& excluded)
      : lattice_(lattice), excluded_(excluded) {
    best_.sum = min_sum;
  }

  SearchOutcome run() {
    const SearchWindow& window = lattice_.window();
    const ShiftBlock all = {{-window.n_x, -window.n_y}, 2 * window.n_x + 1, 2 * window.n_y + 1};
    for (int theta = -window.n_theta; theta <= window.n_theta; ++theta) {
      if (!excluded_) {
        score(theta, all);
        continue;
      }
      for (const ShiftBlock& strip : outside(*excluded_, theta, all)) score(theta, strip);
    }
    return outcome_;
  }

 private:
  void score(int theta, const ShiftBlock& shifts) {
    if (shifts.width <= 0 || shifts.height <= 0) return;
    sums_.compute(lattice_.grid().finest(), lattice_.cells(theta), lattice_.points(), shifts.first,
                  shifts.width, shifts.height);
    for (int y = 0; y < shifts.height; ++y) {
      const std::uint32_t* row = sums_.row(y);
      for (int x = 0; x < shifts.width; ++x) {
        if (row[x] < best_.sum) continue;
        const Candidate candidate = {row[x], {shifts.first.x + x, shifts.first.y + y, theta}};
        if (outcome_.best && !candidate.better_than(best_)) continue;
        best_ = candidate;
        outcome_.best = candidate;
      }
    }
    outcome_.evaluations += static_cast<std::int64_t>(shifts.width) * shifts.height;
  }

  const SearchLattice& lattice_;
  const std::optional<ExcludedRegion>& excluded_;
  Candidate best_;
  ShiftSums sums_;
  SearchOutcome outcome_;
};

}  // namespace

SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded) {
  return Search(lattice, min_sum, excluded).run();
}

}  // namespace psi_slam
