// SPDX-License-Identifier: BSD-3-Clause
// Correlative scan matching (CSM), equations 1 and 2: the exact best pose of the window, refined below a
// cell. Olson, "Real-time correlative scan matching", ICRA 2009.
#pragma once

#include "psi_slam/base/degrees.h"
#include "psi_slam/matching/matcher.h"
#include "psi_slam/matching/refinement.h"

namespace psi_slam {

/// What is the same for every matcher: how a found pose is refined and judged.
struct MatcherOptions {
  RefinementOptions refinement;
  double distinct_m = 0.5;  ///< another peak is distinct when it lies this far away along x or y,
  double distinct_rad = radians_from_degrees(10.0L);  ///< or is turned by this much
  double ambiguity_floor = 0.6;  ///< peaks below this share of the best response are not looked for
  double min_sigma_m = 0.005;    ///< bounds of the covariance's standard deviations
  double max_sigma_m = 2.0;
};

class CorrelativeMatcher : public Matcher {
 public:
  explicit CorrelativeMatcher(const MatcherOptions& options) : options_(options) {}

  MatchResult match(const MatchProblem& problem) const override;
  std::string name() const override { return "csm"; }

 private:
  MatcherOptions options_;
};

}  // namespace psi_slam
