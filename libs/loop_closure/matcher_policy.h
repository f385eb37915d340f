// SPDX-License-Identifier: BSD-3-Clause
// Which matcher searches for loops (method, section 6). The paper: where loops are rare, the exhaustive one, which
// misses none; where they come so often that one missed costs little, the genetic one; in between both, one
// after the other. See PsiOptions for what the defaults make of that.
#pragma once

#include <array>
#include <memory>

#include "loop_closure/loop_closure_factor.h"
#include "matching/make_matcher.h"

namespace psi_slam {

enum class LoopMatcher {
  kCsm,
  kCsmGa,
  kGa,
  kAdaptive,  ///< as the factor Psi says
};

/// Psi <= psi_1 is kCsm, Psi >= psi_2 is kGa, all between is kCsmGa; any other choice than kAdaptive stands
/// whatever Psi is.
MatcherKind matcher_kind(LoopMatcher choice, const PsiOptions& options, double psi);

/// Owns the matchers that a choice may come to.
class MatcherPolicy {
 public:
  MatcherPolicy(LoopMatcher choice, const PsiOptions& psi, const MatcherOptions& matcher,
                const GeneticOptions& genetic);

  MatcherKind kind(double psi) const { return matcher_kind(choice_, psi_, psi); }

  /// Throws std::invalid_argument when kind() never is this one.
  const Matcher& matcher(MatcherKind kind) const;

 private:
  LoopMatcher choice_;
  PsiOptions psi_;
  std::array<std::unique_ptr<const Matcher>, 3> matchers_;  ///< by kind
};

}  // namespace psi_slam
