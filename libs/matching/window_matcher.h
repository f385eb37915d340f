// SPDX-License-Identifier: BSD-3-Clause
// Base of all matchers that search a lattice for the best pose: computes the window, the refinement below a
// cell, the covariance and the ambiguity. The matchers differ in find_peaks() only.
#pragma once

#include <vector>

#include "base/degrees.h"
#include "matching/matcher.h"
#include "matching/refinement.h"
#include "matching/search_lattice.h"

namespace psi_slam {

/// Options for the refinement and the ambiguity of a matched pose.
struct MatcherOptions {
  RefinementOptions refinement;
  double distinct_m = 0.5;                            ///< smallest distance along x or y of a distinct peak
  double distinct_rad = radians_from_degrees(10.0L);  ///< or smallest turn of a distinct peak
  double ambiguity_floor = 0.6;  ///< smallest response of a second peak, as a share of the best
  double min_sigma_m = 0.005;    ///< lower bound of the covariance's standard deviations
  double max_sigma_m = 2.0;
};

/// The peaks of the response that a search must find.
struct PeakRequest {
  std::uint32_t min_sum = 0;  ///< smallest sum of the best peak

  /// Conditions for a second peak: at least `cells` away from the best along x or y, or turned by at least
  /// `turns` steps; and a sum of at least `share` of the best sum.
  struct Next {
    int cells = 1;
    int turns = 1;
    double share = 0;
  };
  std::optional<Next> next;

  MatchSeed seed;  ///< for random searches
};

struct FoundPeaks {
  std::optional<Candidate> best;
  std::optional<Candidate> next;
  std::int64_t evaluations = 0;  ///< poses scored on any level of the grid
  GeneticEffort genetic;
};

/// Puts the requested peaks among `scored` into `peaks`.
void pick_peaks(const std::vector<Candidate>& scored, const PeakRequest& request, FoundPeaks& peaks);

class WindowMatcher : public Matcher {
 public:
  explicit WindowMatcher(const MatcherOptions& options) : options_(options) {}

  MatchResult match(const MatchProblem& problem) const final;

 private:
  virtual FoundPeaks find_peaks(const SearchLattice& lattice, const PeakRequest& request) const = 0;

  MatcherOptions options_;
};

}  // namespace psi_slam
