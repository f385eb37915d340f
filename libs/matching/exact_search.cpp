// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exact_search.h"

#include <cmath>

#include "matching/branch_and_bound.h"

namespace psi_slam {
namespace {

// Windows up to this many poses are searched exhaustively: there the pyramid costs more than it saves.
constexpr std::int64_t kExhaustivePoses = 60'000;

}  // namespace

SearchOutcome exact_search(const SearchLattice& lattice, std::uint32_t min_sum,
                           const std::optional<ExcludedRegion>& excluded) {
  const SearchWindow& window = lattice.window();
  const std::int64_t poses =
      static_cast<std::int64_t>(2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
  const bool exhaustive = poses <= kExhaustivePoses || !lattice.grid().has_pyramid();
  return exhaustive ? exhaustive_search(lattice, min_sum, excluded)
                    : branch_and_bound_search(lattice, min_sum, excluded);
}

void find_next_exactly(const SearchLattice& lattice, const PeakRequest& request, FoundPeaks& peaks) {
  if (!peaks.best || !request.next) return;
  const ExcludedRegion around = {peaks.best->pose, request.next->cells, request.next->turns};
  const auto least = static_cast<std::uint32_t>(std::ceil(request.next->share * peaks.best->sum));
  const SearchOutcome next = exact_search(lattice, least, around);
  peaks.next = next.best;
  peaks.evaluations += next.evaluations;
}

bool needs_exact_next(const SearchWindow& window) {
  return window.n_x <= 32 && window.n_y <= 32;
}

}  // namespace psi_slam
