// SPDX-License-Identifier: BSD-3-Clause
// Base class of all matchers: computes the window, the refinement below a cell, the covariance and the
// ambiguity. The derived matchers differ only in find_peaks(), which searches the lattice.
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
  // A peak is distinct if it is this far from the best peak along x or y, or differs this much in heading.
  double distinct_m = 0.5;
  double distinct_rad = radians_from_degrees(10.0L);
  double ambiguity_floor = 0.6;  ///< smallest response of a second peak, divided by the best response
  double min_sigma_m = 0.005;    ///< bounds of the covariance's standard deviations, see bounded_covariance()
  double max_sigma_m = 2.0;
};

/// The peaks of the response that a search must find.
struct PeakRequest {
  std::uint32_t min_sum = 0;  ///< smallest sum that the best peak may have

  /// Conditions for a second peak. It is at least `cells` away from the best peak along x or y, or at least
  /// `turns` angular steps. Its sum is at least `share` of the best sum.
  struct Next {
    int cells = 1;
    int turns = 1;
    double share = 0;
  };
  std::optional<Next> next;  ///< conditions for the second peak; empty: it is not needed

  MatchSeed seed;  ///< seed of random searches
};

struct FoundPeaks {
  std::optional<Candidate> best;                ///< empty if no pose reaches PeakRequest::min_sum
  std::optional<Candidate> next;                ///< second peak; empty if none meets the conditions
  SearchKind search = SearchKind::kExhaustive;  ///< search that found `best`
  std::int64_t evaluations = 0;                 ///< number of poses scored, on all levels of the grid
  int generations = 0;                          ///< of a genetic search
};

/// Selects the requested peaks from `scored`. Sets `best` and `next` of `peaks`.
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
