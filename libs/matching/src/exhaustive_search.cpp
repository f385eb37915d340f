// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/exhaustive_search.h"

#include <algorithm>

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
    const Shifts all = {-window.n_x, -window.n_y, window.n_x + 1, window.n_y + 1};
    for (int theta = -window.n_theta; theta <= window.n_theta; ++theta) {
      if (excluded_ && std::abs(theta - excluded_->centre.theta) < excluded_->turns)
        score_around(theta, all);
      else
        score(theta, all);
    }
    return outcome_;
  }

 private:
  struct Shifts {  // [x, x_end) x [y, y_end)
    int x;
    int y;
    int x_end;
    int y_end;
  };

  // What the excluded square leaves of `all`: the strips below, above, left and right of it.
  void score_around(int theta, const Shifts& all) {
    const auto edge = [&](int centre, std::int64_t offset, int from, int to) {
      return static_cast<int>(std::clamp<std::int64_t>(centre + offset, from, to));
    };
    const std::int64_t cells = excluded_->cells;
    const int x = edge(excluded_->centre.x, 1 - cells, all.x, all.x_end);
    const int x_end = edge(excluded_->centre.x, cells, x, all.x_end);
    const int y = edge(excluded_->centre.y, 1 - cells, all.y, all.y_end);
    const int y_end = edge(excluded_->centre.y, cells, y, all.y_end);
    score(theta, {all.x, all.y, all.x_end, y});
    score(theta, {all.x, y_end, all.x_end, all.y_end});
    score(theta, {all.x, y, x, y_end});
    score(theta, {x_end, y, all.x_end, y_end});
  }

  void score(int theta, const Shifts& shifts) {
    const int width = shifts.x_end - shifts.x;
    const int height = shifts.y_end - shifts.y;
    if (width <= 0 || height <= 0) return;
    sums_.compute(lattice_.grid().finest(), lattice_.cells(theta), lattice_.points(), {shifts.x, shifts.y},
                  width, height);
    for (int y = 0; y < height; ++y) {
      const std::uint32_t* row = sums_.row(y);
      for (int x = 0; x < width; ++x) {
        if (row[x] < best_.sum) continue;
        const Candidate candidate = {row[x], {shifts.x + x, shifts.y + y, theta}};
        if (outcome_.best && !candidate.better_than(best_)) continue;
        best_ = candidate;
        outcome_.best = candidate;
      }
    }
    outcome_.evaluations += static_cast<std::int64_t>(width) * height;
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
