// SPDX-License-Identifier: BSD-3-Clause
#include "matching/correlative_matcher.h"

#include "matching/exact_search.h"

namespace psi_slam {

FoundPeaks CorrelativeMatcher::find_peaks(const SearchLattice& lattice, const PeakRequest& request) const {
  const SearchOutcome outcome = exact_search(lattice, request.min_sum);
  FoundPeaks peaks;
  peaks.best = outcome.best;
  peaks.evaluations = outcome.evaluations;
  find_next_exactly(lattice, request, peaks);
  return peaks;
}

}  // namespace psi_slam
