// SPDX-License-Identifier: BSD-3-Clause
// Correlative scan matching (CSM), equations 1 and 2: the exact best pose of the window, refined below a
// cell. Olson, "Real-time correlative scan matching", ICRA 2009.
#pragma once

#include "matching/window_matcher.h"

namespace psi_slam {

class CorrelativeMatcher : public WindowMatcher {
 public:
  explicit CorrelativeMatcher(const MatcherOptions& options) : WindowMatcher(options) {}
  std::string name() const override { return "csm"; }

 private:
  FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const override;
};

}  // namespace psi_slam
