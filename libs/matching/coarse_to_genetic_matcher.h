// SPDX-License-Identifier: BSD-3-Clause
// The middle mode of the paper (section 3.2; method, section 6): the rough stage of correlative matching
// ranks coarse cells exhaustively, and the genetic search looks for the best pose inside the best of them. In
// a window of one block (see WindowTiles) only headings are left to rank, which is what the genetic search of
// the whole window begins with: there the two modes are one.
#pragma once

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"

namespace psi_slam {

class CoarseToGeneticMatcher : public WindowMatcher {
 public:
  /// The variant paper searches each of the best 32 cells by the paper's GA, a chromosome of equation 10
  /// each.
  CoarseToGeneticMatcher(const MatcherOptions& options, const GeneticOptions& genetic)
      : WindowMatcher(options), genetic_(genetic) {}
  std::string name() const override { return "csm_ga"; }

 private:
  FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const override;
  FoundPeaks search(const SearchLattice& lattice, const PeakRequest& request) const;

  GeneticOptions genetic_;
};

}  // namespace psi_slam
