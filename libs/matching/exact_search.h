// SPDX-License-Identifier: BSD-3-Clause
// Equation 1 exactly, in the way that suits the window: every pose of a small one, branch and bound in a
// large one.
#pragma once

#include "matching/exhaustive_search.h"
#include "matching/window_matcher.h"

namespace psi_slam {

/// As exhaustive_search(), whose result it has.
SearchOutcome exact_search(const SearchLattice& lattice, std::uint32_t min_sum,
                           const std::optional<ExcludedRegion>& excluded = {});

/// The second peak that `request` asks for, beside `peaks.best`, exactly. Nothing where there is no best one
/// or none is asked for.
void find_next_exactly(const SearchLattice& lattice, const PeakRequest& request, FoundPeaks& peaks);

/// Whether a window is so small, at most 64 shifts a side, that its second peak is to be found exactly
/// whatever finds the first: there it decides whether a loop is believed.
bool needs_exact_next(const SearchWindow& window);

}  // namespace psi_slam
