// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/matcher_policy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

PsiOptions thresholds(double psi_1, double psi_2) {
  PsiOptions options;
  options.psi_1 = psi_1;
  options.psi_2 = psi_2;
  return options;
}

TEST(MatcherPolicy, searches_less_exhaustively_with_more_loops) {
  const PsiOptions options = thresholds(1.5, 4);
  const auto kind = [&](double psi) { return matcher_kind(std::nullopt, options, psi); };
  EXPECT_EQ(kind(0), MatcherKind::kCsm);
  EXPECT_EQ(kind(1.4), MatcherKind::kCsm);
  EXPECT_EQ(kind(2), MatcherKind::kCsmGa);
  EXPECT_EQ(kind(5), MatcherKind::kGa);
}

TEST(MatcherPolicy, thresholds_belong_to_the_outer_modes) {
  const PsiOptions options = thresholds(1.5, 4);
  const auto kind = [&](double psi) { return matcher_kind(std::nullopt, options, psi); };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(kind(1.5), MatcherKind::kCsm);
  EXPECT_EQ(kind(std::nextafter(1.5, inf)), MatcherKind::kCsmGa);
  EXPECT_EQ(kind(std::nextafter(4.0, 0.0)), MatcherKind::kCsmGa);
  EXPECT_EQ(kind(4), MatcherKind::kGa);
}

TEST(MatcherPolicy, a_fixed_choice_does_not_depend_on_psi) {
  for (const double psi : {0.0, 1.0, 2.0, 4.0, 1000.0})
    for (const MatcherKind kind : kMatcherKinds) EXPECT_EQ(matcher_kind(kind, {}, psi), kind);
}

SearchWindow window_of_poses(int poses) {
  SearchWindow window;
  window.n_theta = (poses - 1) / 2;
  return window;
}

TEST(MatcherPolicy, makes_the_matchers_that_it_chooses) {
  const MatcherPolicy adaptive(std::nullopt, thresholds(1, 4), {}, {});
  for (const double psi : {0.0, 2.0, 5.0}) {
    const NodeMatchers matchers = adaptive.matchers(psi);
    EXPECT_EQ(matchers.by_psi.kind, adaptive.kind(psi));
    EXPECT_EQ(matchers.by_psi.matcher.name(), name(adaptive.kind(psi)));
  }
}

TEST(MatcherPolicy, large_windows_are_searched_genetically_at_any_psi) {
  PsiOptions options = thresholds(1, 4);
  options.max_poses = 1001;
  const MatcherPolicy policy(std::nullopt, options, {}, {});
  for (const double psi : {0.0, 2.0, 5.0}) {
    const NodeMatchers matchers = policy.matchers(psi);
    EXPECT_EQ(matchers.in(window_of_poses(1001)).kind, matchers.by_psi.kind);
    EXPECT_EQ(matchers.in(window_of_poses(1003)).kind, MatcherKind::kGa);
    EXPECT_EQ(matchers.in(window_of_poses(1003)).matcher.name(), "ga");
  }
}

TEST(MatcherPolicy, a_fixed_choice_searches_all_windows) {
  PsiOptions options;
  options.max_poses = 0;
  for (const MatcherKind kind : kMatcherKinds) {
    const MatcherPolicy fixed(kind, options, {}, {});
    EXPECT_EQ(fixed.matchers(0).in(window_of_poses(1'000'001)).matcher.name(), name(kind));
  }
}

}  // namespace
}  // namespace psi_slam
