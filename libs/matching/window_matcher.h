// SPDX-License-Identifier: BSD-3-Clause
// What all matchers share that look for the best pose of a lattice: the window, the refinement below a cell,
// the covariance, the ambiguity. They differ in find_peaks() alone.
#pragma once

#include <vector>

#include "base/degrees.h"
#include "matching/matcher.h"
#include "matching/refinement.h"
#include "matching/search_lattice.h"

namespace psi_slam {

/// How a found pose is refined and judged.
struct MatcherOptions {
  RefinementOptions refinement;
  double distinct_m = 0.5;  ///< another peak is distinct when it lies this far away along x or y,
  double distinct_rad = radians_from_degrees(10.0L);  ///< or is turned by this much
  double ambiguity_floor = 0.6;  ///< peaks below this share of the best response are not looked for
  double min_sigma_m = 0.005;    ///< bounds of the covariance's standard deviations
  double max_sigma_m = 2.0;
};

/// Which peaks of the response a search is asked for.
struct PeakRequest {
  std::uint32_t min_sum = 0;  ///< lower ones are not wanted

  /// A second one, distinct from the best: at least so many cells away along x or y or turned by so many
  /// steps, and of at least this share of the best one's sum.
  struct Next {
    int cells = 1;
    int turns = 1;
    double share = 0;
  };
  std::optional<Next> next;

  MatchSeed seed;  ///< of random searches
};

struct FoundPeaks {
  std::optional<Candidate> best;
  std::optional<Candidate> next;
  std::int64_t evaluations = 0;  ///< poses scored on any level of the grid
  GeneticEffort genetic;
};

/// The peaks that are asked for among scored poses, into `peaks`.
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
