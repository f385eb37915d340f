// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/matcher_policy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

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

TEST(MatcherPolicy, searches_genetically_where_the_place_is_unknown) {
  const MatcherPolicy adaptive(std::nullopt, thresholds(1, 4), {}, {});
  EXPECT_EQ(adaptive.matcher(adaptive.kind_anywhere()).kind, MatcherKind::kGa);
  for (const MatcherKind kind : kMatcherKinds)
    EXPECT_EQ(MatcherPolicy(kind, {}, {}, {}).kind_anywhere(), kind);
}

TEST(MatcherPolicy, owns_the_matchers_it_may_choose) {
  const MatcherPolicy adaptive(std::nullopt, thresholds(1, 4), {}, {});
  for (const MatcherKind kind : kMatcherKinds) EXPECT_EQ(adaptive.matcher(kind).matcher.name(), name(kind));
  EXPECT_EQ(adaptive.kind(2), MatcherKind::kCsmGa);

  const MatcherPolicy fixed(MatcherKind::kGa, {}, {}, {});
  EXPECT_EQ(fixed.matcher(fixed.kind(0)).matcher.name(), "ga");
  EXPECT_THROW(fixed.matcher(MatcherKind::kCsm), std::invalid_argument);
  EXPECT_THROW(fixed.matcher(MatcherKind::kCsmGa), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
