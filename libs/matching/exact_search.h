// SPDX-License-Identifier: BSD-3-Clause
// Exact searches of a window for the best pose of equation 1. All searches return the same pose, also if
// several poses have the same sum.
#pragma once

#include <cstdint>
#include <memory>
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

/// Finds the same pose as exhaustive_search(), by branch and bound (Olson 2009; Hess et al. 2016). Unlike the
/// depth-first searches of these papers, it bounds blocks of shifts and headings. It bounds all blocks of the
/// coarsest level first, then expands the layers of headings in descending order of their bounds, each level
/// by level.
SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded = {});

/// Exact searches of one window. Later searches reuse the bounds of the first.
class ExactSearch {
 public:
  class BranchAndBound;

  /// Keeps a reference to the lattice.
  explicit ExactSearch(const SearchLattice& lattice);
  ~ExactSearch();
  ExactSearch(const ExactSearch&) = delete;
  ExactSearch& operator=(const ExactSearch&) = delete;

  /// Finds the same pose as exhaustive_search(). Uses branch and bound if the window is large.
  SearchOutcome find(std::uint32_t min_sum, const std::optional<ExcludedRegion>& excluded = {});

  /// Finds the second peak that `request` asks for, around `peaks.best`. Does nothing without a best peak, or
  /// if `request.next` is empty.
  void find_next(const PeakRequest& request, FoundPeaks& peaks);

 private:
  const SearchLattice& lattice_;
  std::unique_ptr<BranchAndBound> branch_and_bound_;  // made by the first search of a large window
};

/// Returns whether the half-widths of a window are at most 32 steps along x and y. In such windows, loops are
/// verified by the ratio of the two best peaks. So the genetic matchers find the second peak exactly too.
bool needs_exact_next(const SearchWindow& window);

}  // namespace psi_slam
