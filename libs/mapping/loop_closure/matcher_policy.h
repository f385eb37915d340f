// SPDX-License-Identifier: BSD-3-Clause
// Chooses the matcher that searches for loops. Where loops are rare, the paper searches exhaustively, because
// a missed loop costs much. Where loops are frequent, the paper uses the genetic matcher. Between these
// cases, it combines both. In contrast to the paper, the genetic matcher also searches all large windows,
// because the time of an exact search has no bound there.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "mapping/loop_closure/loop_closure_factor.h"
#include "matching/make_matcher.h"
#include "matching/search_window.h"

namespace psi_slam {

/// Returns `choice` if it has a value; otherwise kCsm for psi <= psi_1, kGa for psi >= psi_2, and kCsmGa in
/// between.
MatcherKind matcher_kind(std::optional<MatcherKind> choice, const PsiOptions& options, double psi);

struct ChosenMatcher {
  MatcherKind kind;
  const Matcher& matcher;
};

/// The matchers of one node.
struct NodeMatchers {
  ChosenMatcher by_psi;
  /// Matcher for windows with more than `max_poses` poses; empty: by_psi searches all windows.
  std::optional<ChosenMatcher> of_large_windows = {};
  double max_poses = 0;

  const ChosenMatcher& in(const SearchWindow& window) const {
    return of_large_windows && window.poses() > max_poses ? *of_large_windows : by_psi;
  }
};

/// Chooses matchers by Psi, and owns them.
class MatcherPolicy {
 public:
  MatcherPolicy(std::optional<MatcherKind> choice, const PsiOptions& psi, const MatcherOptions& matcher,
                const GeneticOptions& genetic);

  MatcherKind kind(double psi) const { return matcher_kind(choice_, psi_, psi); }

  /// Returns the matchers of a node.
  NodeMatchers matchers(double psi) const;

 private:
  ChosenMatcher matcher(MatcherKind kind) const;

  std::optional<MatcherKind> choice_;
  PsiOptions psi_;
  /// Matchers by kind; null for a kind that is never chosen.
  std::array<std::unique_ptr<const Matcher>, kMatcherKinds.size()> matchers_;
};

}  // namespace psi_slam
