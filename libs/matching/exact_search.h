// SPDX-License-Identifier: BSD-3-Clause
// Exact searches of a window for the best pose of equation 1. All searches return the same pose, also if
// several poses have the same sum.
#pragma once

#include <cstdint>
#include <optional>

#include "matching/search_lattice.h"
#include "matching/window_matcher.h"

namespace psi_slam {

struct SearchOutcome {
  std::optional<Candidate> best;  ///< empty if no pose reaches the smallest sum
  std::int64_t evaluations = 0;   ///< number of poses scored, on all levels of the grid
  SearchKind search = SearchKind::kExhaustive;
};

/// Scores every pose of the window outside `excluded`. Returns the best pose in Candidate's order, if its sum
/// is at least `min_sum`. This is the fastest search of small windows, because neighbouring shifts share
/// memory accesses. Tests compare the other searches with it.
SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded = {});

/// Finds the same pose as exhaustive_search(), by branch and bound on the score grid's pyramid (Olson 2009;
/// Hess et al. 2016). Unlike the depth-first searches of these papers, it first sums the coarsest level for
/// the whole window. It then visits the blocks in descending order of their bounds, and expands each block
/// into 16 children. Throws std::invalid_argument if the lattice's grid has no pyramid.
SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded = {});

/// Finds the same pose as exhaustive_search(). Uses branch and bound if the window is large and the grid has
/// a pyramid.
SearchOutcome exact_search(const SearchLattice& lattice, std::uint32_t min_sum,
                           const std::optional<ExcludedRegion>& excluded = {});

/// Finds the second peak that `request` asks for, by an exact search around `peaks.best`. Does nothing
/// without a best peak, or if `request.next` is empty.
void find_next_exactly(const SearchLattice& lattice, const PeakRequest& request, FoundPeaks& peaks);

/// Returns whether the half-widths of a window are at most 32 steps along x and y. In such windows, loops are
/// verified by the ratio of the two best peaks. So the genetic matchers find the second peak exactly too.
bool needs_exact_next(const SearchWindow& window);

}  // namespace psi_slam
