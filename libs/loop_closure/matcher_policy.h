// SPDX-License-Identifier: BSD-3-Clause
// Chooses the matcher that searches for loops. Where loops are rare, the paper searches exhaustively, because
// a missed loop costs much. Where loops are frequent, the paper uses the genetic matcher. Between these
// cases, it combines both. PsiOptions describes how the defaults differ from the paper.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "loop_closure/loop_closure_factor.h"
#include "matching/make_matcher.h"

namespace psi_slam {

/// Returns `choice` if it has a value; otherwise kCsm for psi <= psi_1, kGa for psi >= psi_2, and kCsmGa in
/// between.
MatcherKind matcher_kind(std::optional<MatcherKind> choice, const PsiOptions& options, double psi);

struct ChosenMatcher {
  MatcherKind kind;
  const Matcher& matcher;
};

/// Chooses matchers by Psi, and owns them.
class MatcherPolicy {
 public:
  MatcherPolicy(std::optional<MatcherKind> choice, const PsiOptions& psi, const MatcherOptions& matcher,
                const GeneticOptions& genetic);

  MatcherKind kind(double psi) const { return matcher_kind(choice_, psi_, psi); }

  /// Matcher for a node whose place is unknown. Psi says nothing about windows of whole local maps.
  MatcherKind kind_anywhere() const { return choice_.value_or(kWholeMapMatcher); }

  /// Returns the matcher of a kind. Throws std::invalid_argument if neither kind() nor kind_anywhere() ever
  /// returns `kind`.
  ChosenMatcher matcher(MatcherKind kind) const;

 private:
  std::optional<MatcherKind> choice_;
  PsiOptions psi_;
  /// Matchers by kind; null for a kind that is never chosen.
  std::array<std::unique_ptr<const Matcher>, kMatcherKinds.size()> matchers_;
};

}  // namespace psi_slam
