// SPDX-License-Identifier: BSD-3-Clause
// Exact searches of a window for the best pose of equation 1. All return the same pose, ties included.
#pragma once

#include <cstdint>
#include <optional>

#include "matching/search_lattice.h"
#include "matching/window_matcher.h"

namespace psi_slam {

struct SearchOutcome {
  std::optional<Candidate> best;  ///< empty if no pose reaches the smallest sum
  std::int64_t evaluations = 0;   ///< poses scored on any level of the grid
};

/// Returns the best of all poses outside `excluded` whose sum is at least `min_sum`, in Candidate's order.
/// Scores every pose of the window. This is the fastest way for small windows, because neighbouring shifts
/// share memory accesses, and the reference for the tests of the other searches.
SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded = {});

/// Returns what exhaustive_search() returns, by branch and bound on the score grid's pyramid (Olson 2009;
/// Hess et al. 2016). Unlike the depth-first trees of those papers, it sums the coarsest level for the whole
/// window at once, visits the blocks in descending order of their bounds, and expands each into 16 children.
/// Throws std::invalid_argument if the lattice's grid has no pyramid.
SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded = {});

/// Returns what exhaustive_search() returns; uses branch and bound if the window is large.
SearchOutcome exact_search(const SearchLattice& lattice, std::uint32_t min_sum,
                           const std::optional<ExcludedRegion>& excluded = {});

/// Finds the second peak that `request` asks for, distinct from `peaks.best`, exactly. Does nothing if there
/// is no best peak or no second one is asked for.
void find_next_exactly(const SearchLattice& lattice, const PeakRequest& request, FoundPeaks& peaks);

/// Whether a window has at most 64 shifts a side. Loops are verified in such windows by the ratio of the two
/// best peaks, so genetic searches find the second peak exactly too.
bool needs_exact_next(const SearchWindow& window);

}  // namespace psi_slam
