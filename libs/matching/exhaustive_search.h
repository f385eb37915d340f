// SPDX-License-Identifier: BSD-3-Clause
// Equation 1 by trying every pose of the window: the fastest way for small windows, since neighbouring shifts
// share their memory accesses, and the reference that the branch and bound search is tested against.
#pragma once

#include <cstdint>
#include <optional>

#include "matching/search_lattice.h"

namespace psi_slam {

struct SearchOutcome {
  std::optional<Candidate> best;  ///< none when no pose reaches the smallest sum asked for
  std::int64_t evaluations = 0;
};

/// The best of all poses whose sum is at least `min_sum`, in Candidate's order.
SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded = {});

}  // namespace psi_slam
