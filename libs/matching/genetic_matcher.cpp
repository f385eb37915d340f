// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_matcher.h"

#include "matching/exact_search.h"
#include "matching/memetic_search.h"
#include "matching/paper_genetic_search.h"

namespace psi_slam {

FoundPeaks GeneticMatcher::find_peaks(const SearchLattice& lattice, const PeakRequest& request) const {
  FoundPeaks peaks = genetic_.variant == GeneticVariant::kPaper
                         ? paper_genetic_search(lattice, request, genetic_.paper)
                         : memetic_search(lattice, request, genetic_.memetic);
  if (needs_exact_next(lattice.window())) find_next_exactly(lattice, request, peaks);
  return peaks;
}

}  // namespace psi_slam
