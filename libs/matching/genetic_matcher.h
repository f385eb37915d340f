// SPDX-License-Identifier: BSD-3-Clause
// Scan matching by a genetic algorithm on binary chromosomes: the paper's, or the memetic one that goes
// beyond it (see GeneticVariant).
#pragma once

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"

namespace psi_slam {

class GeneticMatcher : public WindowMatcher {
 public:
  GeneticMatcher(const MatcherOptions& options, const GeneticOptions& genetic)
      : WindowMatcher(options), genetic_(genetic) {}
  std::string name() const override { return "ga"; }

 private:
  FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const override;

  GeneticOptions genetic_;
};

}  // namespace psi_slam
