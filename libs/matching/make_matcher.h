// SPDX-License-Identifier: BSD-3-Clause
// Creates the matchers of the paper. `.ini` files and records use the same names.
#pragma once

#include <memory>

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"
#include "psi_slam/matching.h"

namespace psi_slam {

/// Correlative scan matching (CSM), equations 1 and 2: finds the exact best pose of the window, then refines
/// it below a cell. Olson, "Real-time correlative scan matching", ICRA 2009.
class CorrelativeMatcher : public WindowMatcher {
 public:
  explicit CorrelativeMatcher(const MatcherOptions& options) : WindowMatcher(options) {}
  std::string name() const override { return "csm"; }

 private:
  FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const override;
};

/// Matcher for large windows, such as whole maps and whole local maps at any heading. An exact search is slow
/// where nothing fits, and most searches in such windows find nothing. See share/doc/matchers.md, "Which
/// search is better where".
inline constexpr MatcherKind kLargeWindowMatcher = MatcherKind::kGa;

/// Creates a matcher. `genetic` has no effect on kCsm.
std::unique_ptr<Matcher> make_matcher(MatcherKind kind, const MatcherOptions& options,
                                      const GeneticOptions& genetic);

}  // namespace psi_slam
