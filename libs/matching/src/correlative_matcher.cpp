// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/correlative_matcher.h"

#include <cmath>

#include "psi_slam/matching/branch_and_bound.h"
#include "psi_slam/matching/exhaustive_search.h"

namespace psi_slam {
namespace {

// Windows up to this many poses are searched exhaustively: there the pyramid costs more than it saves.
constexpr std::int64_t kExhaustivePoses = 60'000;

SearchOutcome search(const SearchLattice& lattice, std::uint32_t min_sum,
                     const std::optional<ExcludedRegion>& excluded = {}) {
  const SearchWindow& window = lattice.window();
  const std::int64_t poses =
      static_cast<std::int64_t>(2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
  const bool exhaustive = poses <= kExhaustivePoses || !lattice.grid().has_pyramid();
  return exhaustive ? exhaustive_search(lattice, min_sum, excluded)
                    : branch_and_bound_search(lattice, min_sum, excluded);
}

std::uint32_t least_sum(double sum) {
  return static_cast<std::uint32_t>(std::ceil(sum));
}

}  // namespace

FoundPeaks CorrelativeMatcher::find_peaks(const SearchLattice& lattice, const PeakRequest& request) const {
  const SearchOutcome outcome = search(lattice, request.min_sum);
  FoundPeaks peaks;
  peaks.best = outcome.best;
  peaks.evaluations = outcome.evaluations;
  if (peaks.best && request.next) {
    const ExcludedRegion around = {peaks.best->pose, request.next->cells, request.next->turns};
    const SearchOutcome next = search(lattice, least_sum(request.next->share * peaks.best->sum), around);
    peaks.next = next.best;
    peaks.evaluations += next.evaluations;
  }
  return peaks;
}

}  // namespace psi_slam
