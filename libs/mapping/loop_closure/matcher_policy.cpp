// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/matcher_policy.h"

namespace psi_slam {

MatcherKind matcher_kind(std::optional<MatcherKind> choice, const PsiOptions& options, double psi) {
  if (choice) return *choice;
  if (psi <= options.psi_1) return MatcherKind::kCsm;
  return psi >= options.psi_2 ? MatcherKind::kGa : MatcherKind::kCsmGa;
}

MatcherPolicy::MatcherPolicy(std::optional<MatcherKind> choice, const PsiOptions& psi,
                             const MatcherOptions& matcher, const GeneticOptions& genetic)
    : choice_(choice), psi_(psi) {
  for (const MatcherKind kind : kMatcherKinds)
    if (!choice || *choice == kind)
      matchers_[static_cast<std::size_t>(kind)] = make_matcher(kind, matcher, genetic);
}

ChosenMatcher MatcherPolicy::matcher(MatcherKind kind) const {
  return {kind, *matchers_.at(static_cast<std::size_t>(kind))};
}

NodeMatchers MatcherPolicy::matchers(double psi) const {
  NodeMatchers matchers = {matcher(kind(psi))};
  if (!choice_) matchers.of_large_windows.emplace(matcher(kLargeWindowMatcher));
  matchers.max_poses = psi_.max_poses;
  return matchers;
}

}  // namespace psi_slam
