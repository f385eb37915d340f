// SPDX-License-Identifier: BSD-3-Clause
// Tests of every matcher through the common interface.
#include "matching/make_matcher.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "score_grids.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Kind {
  MatcherKind kind;
  GeneticVariant variant;
  std::string name;
};

class EveryMatcher : public testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Matcher> matcher(const MatcherOptions& options = {}) const {
    GeneticOptions genetic;
    genetic.variant = GetParam().variant;
    return make_matcher(GetParam().kind, options, genetic);
  }
  SimulatedWalls walls = furnished_room();
  ScoreGrid grid = grid_of(walls);
};

INSTANTIATE_TEST_SUITE_P(MakeMatcher, EveryMatcher,
                         testing::Values(Kind{MatcherKind::kCsm, GeneticVariant::kMemetic, "csm"},
                                         Kind{MatcherKind::kCsmGa, GeneticVariant::kMemetic, "csm_ga"},
                                         Kind{MatcherKind::kGa, GeneticVariant::kMemetic, "ga"},
                                         Kind{MatcherKind::kCsmGa, GeneticVariant::kPaper, "csm_ga_paper"},
                                         Kind{MatcherKind::kGa, GeneticVariant::kPaper, "ga_paper"}),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(EveryMatcher, has_its_name) {
  EXPECT_EQ(matcher()->name(), name(GetParam().kind));
  EXPECT_EQ(GetParam().name.rfind(matcher()->name(), 0), 0U);
}

TEST_P(EveryMatcher, finds_random_poses) {
  std::mt19937_64 random(121);
  std::uniform_real_distribution<double> x(2.0, 6.0);
  std::uniform_real_distribution<double> y(1.5, 4.0);
  std::uniform_real_distribution<double> heading(-M_PI, M_PI);
  std::uniform_real_distribution<double> share(-0.7, 0.7);
  const int trials = 30;
  int found = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const TPose2D truth(x(random), y(random), heading(random));
    const ScanPoints scan = scan_of(walls, truth, 180, 0.01, random);
    const double half_m = trial % 2 == 0 ? 0.4 : 3.0;
    const TPose2D predicted(truth.x + share(random) * half_m, truth.y + share(random) * half_m,
                            truth.phi + share(random) * 0.4);
    MatchProblem problem{grid, scan, predicted, {half_m, half_m, 0.4}};
    problem.seed = {1, static_cast<std::uint64_t>(trial), 2};
    const MatchResult match = matcher()->match(problem);
    ASSERT_TRUE(match.found);
    const TPose2D off = match.map_T_robot - truth;
    if (std::hypot(off.x, off.y) < 0.01 && std::abs(mrpt::math::wrapToPi(off.phi)) < 0.005) ++found;
  }
  EXPECT_GE(found, GetParam().variant == GeneticVariant::kPaper ? trials / 2 : trials);
}

TEST_P(EveryMatcher, returns_the_response_of_its_pose_and_a_covariance) {
  std::mt19937_64 random(122);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  MatchProblem problem{grid, scan, {4.5, 2.6, 0.2}, {2, 2, 0.4}};
  problem.measure_ambiguity = true;
  const MatchResult match = matcher()->match(problem);
  ASSERT_TRUE(match.found);
  const RefinedPose at_lattice = [&] {
    RefinementOptions as_it_is;
    as_it_is.max_iterations = 0;
    return refine(grid, scan, match.lattice_pose, as_it_is);
  }();
  EXPECT_NEAR(match.response, at_lattice.mean_score, 0.1)
      << "the response is a mean over cells, the score is interpolated";
  EXPECT_GE(match.refined_response, at_lattice.mean_score);
  EXPECT_GT(match.covariance(0, 0), 0);
  EXPECT_GT(match.information(2, 2), 0);
  ASSERT_TRUE(match.ambiguity);
  EXPECT_GE(*match.ambiguity, 0);
  EXPECT_LE(*match.ambiguity, 1);
  EXPECT_GT(match.evaluations, 0);
}

// The window of 0.3 m has fewer poses than branch and bound is worth, and it is one block of the memetic
// search.
TEST_P(EveryMatcher, names_the_search_that_ran) {
  std::mt19937_64 random(127);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  const auto search_in = [&](double half_m, double half_rad) {
    return matcher()->match({grid, scan, {4.1, 2.9, 0.25}, {half_m, half_m, half_rad}}).search;
  };
  const std::string& name = GetParam().name;
  const SearchKind narrow = search_in(0.3, 0.1);
  const SearchKind wide = search_in(3, 0.5);
  EXPECT_EQ(narrow, name == "csm"            ? SearchKind::kExhaustive
                    : name == "csm_ga_paper" ? SearchKind::kCoarseGenetic
                    : name == "ga_paper"     ? SearchKind::kGenetic
                                             : SearchKind::kLocal);
  EXPECT_EQ(wide, name == "csm"               ? SearchKind::kBranchAndBound
                  : name.rfind("csm_ga") == 0 ? SearchKind::kCoarseGenetic
                                              : SearchKind::kGenetic);
}

TEST(MakeMatcher, a_genetic_matcher_without_generations_is_named_a_local_or_coarse_search) {
  SimulatedWalls walls = furnished_room();
  const ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random(128);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  GeneticOptions genetic;
  genetic.memetic.generations = 0;
  const MatchProblem problem{grid, scan, {4.5, 2.6, 0.2}, {3, 3, 0.4}};
  EXPECT_EQ(make_matcher(MatcherKind::kGa, {}, genetic)->match(problem).search, SearchKind::kLocal);
  EXPECT_EQ(make_matcher(MatcherKind::kCsmGa, {}, genetic)->match(problem).search, SearchKind::kCoarse);
  MatchProblem hopeless{grid, scan, {400, 3, 0.3}, {3, 3, 0.4}};
  hopeless.min_response = 0.4;
  EXPECT_EQ(make_matcher(MatcherKind::kCsmGa, {}, {})->match(hopeless).search, SearchKind::kCoarse)
      << "no coarse cell is worth a generation";
}

// In a corridor with doors 1.2 m apart, a scan also matches 1.2 m farther along. Verification rejects such
// matches by their ambiguity, which must not depend on the matcher.
TEST_P(EveryMatcher, finds_the_second_peak_of_a_narrow_window_exactly) {
  SimulatedWalls corridor;
  corridor.add_wall(-8, -1, 8, -1);
  for (int door = -6; door <= 6; ++door) {
    corridor.add_wall(1.2 * door, 1, 1.2 * door + 0.7, 1);
    corridor.add_wall(1.2 * door, 1, 1.2 * door, 1.15);
  }
  corridor.add_box(-8, -3, 8, 3);
  const ScoreGrid corridor_grid = grid_of(corridor);
  std::mt19937_64 random(126);
  const CorrelativeMatcher exact({});
  int ambiguous = 0;
  for (const double half_m : {0.4, 0.7, 0.9, 1.0}) {
    for (int trial = 0; trial < 5; ++trial) {
      const TPose2D truth(0.17 * trial, 0.1, 0.02 * trial);
      const ScanPoints scan = scan_of(corridor, truth, 180, 0.01, random);
      MatchProblem problem{corridor_grid,
                           scan,
                           {truth.x + 0.8 * half_m, truth.y - 0.05, truth.phi + 0.02},
                           {half_m, half_m, 0.1}};
      problem.measure_ambiguity = true;
      problem.seed = {1, static_cast<std::uint64_t>(trial), 2};
      const MatchResult expected = exact.match(problem);
      const MatchResult match = matcher()->match(problem);
      ASSERT_TRUE(match.ambiguity && expected.ambiguity);
      if (*expected.ambiguity > 0.7) ++ambiguous;
      EXPECT_GE(*match.ambiguity, *expected.ambiguity - 0.02);
    }
  }
  EXPECT_GT(ambiguous, 2) << "the test needs ambiguous matches";
}

TEST_P(EveryMatcher, finds_nothing_if_no_pose_matches) {
  std::mt19937_64 random(123);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  MatchProblem problem{grid, scan, {400, 3, 0.3}, {2, 2, 0.4}};
  problem.min_response = 0.4;
  const MatchResult match = matcher()->match(problem);
  EXPECT_FALSE(match.found);
  EXPECT_EQ(match.response, 0);
}

TEST_P(EveryMatcher, gives_the_same_result_on_any_thread) {
  std::mt19937_64 random(124);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  MatchProblem problem{grid, scan, {4.5, 2.6, 0.2}, {2, 2, 0.4}};
  problem.seed = {1, 2, 3};
  const auto shared = matcher();
  const MatchResult expected = shared->match(problem);
  std::vector<MatchResult> results(4);
  std::vector<std::thread> threads;
  for (MatchResult& result : results) threads.emplace_back([&] { result = shared->match(problem); });
  for (std::thread& thread : threads) thread.join();
  for (const MatchResult& result : results) {
    EXPECT_EQ(result.map_T_robot, expected.map_T_robot);
    EXPECT_EQ(result.response, expected.response);
    EXPECT_EQ(result.evaluations, expected.evaluations);
  }
}

TEST_P(EveryMatcher, refuses_a_degenerate_window) {
  std::mt19937_64 random(125);
  const ScanPoints scan = scan_of(walls, {4, 3, 0.3}, 120, 0.01, random);
  EXPECT_THROW(matcher()->match({grid, scan, {4, 3, 0}, {0, 1, 0.1}}), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
