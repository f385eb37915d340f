// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/matcher_policy.h"

#include <stdexcept>
#include <string>

namespace psi_slam {

MatcherKind matcher_kind(LoopMatcher choice, const PsiOptions& options, double psi) {
  switch (choice) {
    case LoopMatcher::kCsm:
      return MatcherKind::kCsm;
    case LoopMatcher::kCsmGa:
      return MatcherKind::kCsmGa;
    case LoopMatcher::kGa:
      return MatcherKind::kGa;
    case LoopMatcher::kAdaptive:
      break;
  }
  if (psi <= options.psi_1) return MatcherKind::kCsm;
  return psi >= options.psi_2 ? MatcherKind::kGa : MatcherKind::kCsmGa;
}

MatcherPolicy::MatcherPolicy(LoopMatcher choice, const PsiOptions& psi, const MatcherOptions& matcher,
                             const GeneticOptions& genetic)
    : choice_(choice), psi_(psi) {
  for (const MatcherKind kind : {MatcherKind::kCsm, MatcherKind::kCsmGa, MatcherKind::kGa})
    if (choice == LoopMatcher::kAdaptive || matcher_kind(choice, psi, 0) == kind)
      matchers_[static_cast<std::size_t>(kind)] = make_matcher(kind, matcher, genetic);
}

const Matcher& MatcherPolicy::matcher(MatcherKind kind) const {
  const auto& matcher = matchers_.at(static_cast<std::size_t>(kind));
  if (!matcher) throw std::invalid_argument(std::string("MatcherPolicy: it never comes to ") + name(kind));
  return *matcher;
}

}  // namespace psi_slam
