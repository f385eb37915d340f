// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/matcher_policy.h"

#include <stdexcept>
#include <string>

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
  const auto& matcher = matchers_.at(static_cast<std::size_t>(kind));
  if (!matcher) throw std::invalid_argument(std::string("MatcherPolicy never chooses ") + name(kind));
  return {kind, *matcher};
}

}  // namespace psi_slam
