// SPDX-License-Identifier: BSD-3-Clause
#include "matching/make_matcher.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "matching/exact_search.h"
#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Room {
  SimulatedWalls walls = furnished_room();
  ScoreGrid grid = grid_of(walls);
};

void expect_same_result(const MatchResult& a, const MatchResult& b) {
  EXPECT_EQ(a.found, b.found);
  EXPECT_EQ(a.map_T_robot, b.map_T_robot);
  EXPECT_EQ(a.lattice_pose, b.lattice_pose);
  EXPECT_EQ(a.response, b.response);
  EXPECT_EQ(a.refined_response, b.refined_response);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.ambiguity, b.ambiguity);
}

TEST(CorrelativeMatcher, finds_fifty_random_poses) {
  const Room room;
  const CorrelativeMatcher matcher({});
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> x(2.0, 6.0);
  std::uniform_real_distribution<double> y(1.5, 4.0);
  std::uniform_real_distribution<double> heading(-M_PI, M_PI);
  std::uniform_real_distribution<double> share(-0.95, 0.95);
  for (int trial = 0; trial < 50; ++trial) {
    const TPose2D truth(x(random), y(random), heading(random));
    const ScanPoints scan = scan_of(room.walls, truth, 360, 0.01, random);
    // Small windows are searched exhaustively, large windows by branch and bound.
    const double half_m = trial % 2 == 0 ? 0.4 : 2.0;
    const TPose2D predicted(truth.x + share(random) * half_m, truth.y + share(random) * half_m,
                            truth.phi + share(random) * 0.4);
    const MatchResult match = matcher.match({room.grid, scan, predicted, {half_m, half_m, 0.4}});
    ASSERT_TRUE(match.found);
    EXPECT_NEAR(match.map_T_robot.x, truth.x, 0.003) << "trial " << trial;
    EXPECT_NEAR(match.map_T_robot.y, truth.y, 0.003) << "trial " << trial;
    EXPECT_NEAR(mrpt::math::wrapToPi(match.map_T_robot.phi - truth.phi), 0, 0.001) << "trial " << trial;
  }
}

TEST(CorrelativeMatcher, fills_in_every_field) {
  const Room room;
  MatcherOptions options;
  std::mt19937_64 random(72);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 60, 0.02, random);
  const MatchProblem problem{room.grid, scan, {4.1, 2.95, 0.25}, {0.3, 0.25, 0.2}};
  const MatchResult match = CorrelativeMatcher(options).match(problem);

  const SearchWindow window = make_search_window(problem.extent, 0.05, scan.farthest_m);
  EXPECT_EQ(match.window.n_x, window.n_x);
  EXPECT_EQ(match.window.n_y, window.n_y);
  EXPECT_EQ(match.window.n_theta, window.n_theta);
  EXPECT_EQ(match.window.linear_step_m, window.linear_step_m);
  EXPECT_EQ(match.window.angular_step_rad, window.angular_step_rad);
  EXPECT_EQ(match.evaluations, (2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1));

  const SearchLattice lattice(room.grid, scan, problem.map_T_robot, window);
  const std::optional<Candidate> best = slow_search(lattice, 0);
  EXPECT_TRUE(match.found);
  EXPECT_EQ(match.lattice_pose, lattice.pose(best->pose));
  EXPECT_EQ(match.response, best->sum / (255.0 * 60));

  const RefinedPose refined = refine(room.grid, scan, match.lattice_pose, options.refinement);
  EXPECT_EQ(match.map_T_robot, refined.map_T_robot);
  EXPECT_EQ(match.refined_response, refined.mean_score);
  EXPECT_EQ(match.information, refined.information);
  EXPECT_EQ(match.covariance, bounded_covariance(refined.information, options.min_sigma_m,
                                                 options.max_sigma_m, scan.farthest_m));
  EXPECT_FALSE(match.ambiguity) << "the ambiguity was not requested";
}

TEST(CorrelativeMatcher, passes_the_prior_on_to_the_refinement) {
  const Room room;
  std::mt19937_64 random(73);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 60, 0.01, random);
  MatchProblem problem{room.grid, scan, {4.02, 3.01, 0.3}, {0.3, 0.3, 0.2}};
  problem.prior = PosePrior{problem.map_T_robot, Eigen::Matrix3d::Identity() * 1e10};
  const MatchResult match = CorrelativeMatcher({}).match(problem);
  EXPECT_NEAR(match.map_T_robot.x, 4.02, 1e-4);
  EXPECT_NEAR(match.map_T_robot.y, 3.01, 1e-4);
}

TEST(CorrelativeMatcher, large_windows_need_neither_the_pyramid_nor_all_poses) {
  const Room room;
  ScoreGrid flat = room.grid;
  flat.drop_pyramid();
  std::mt19937_64 random(74);
  for (int trial = 0; trial < 5; ++trial) {
    const ScanPoints scan = scan_of(room.walls, {3, 3.5, 1.0 * trial}, 90, 0.02, random);
    const TPose2D predicted(3.7, 2.6, trial - 0.1);
    MatchProblem with{room.grid, scan, predicted, {2, 2, 0.3}};
    MatchProblem without{flat, scan, predicted, {2, 2, 0.3}};
    with.measure_ambiguity = without.measure_ambiguity = true;
    const MatchResult match = CorrelativeMatcher({}).match(with);
    expect_same_result(match, CorrelativeMatcher({}).match(without));
    const SearchLattice lattice(room.grid, scan, predicted, match.window);
    const Candidate best = exhaustive_search(lattice, 0).best.value();
    EXPECT_EQ(match.lattice_pose, lattice.pose(best.pose));
    EXPECT_EQ(match.response, lattice.response(best.sum));
    const SearchWindow& window = match.window;
    const std::int64_t poses =
        std::int64_t{2 * window.n_x + 1} * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
    EXPECT_LT(match.evaluations, poses / 10);
  }
}

TEST(CorrelativeMatcher, below_the_least_response_nothing_is_found) {
  const Room room;
  std::mt19937_64 random(75);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 100, 0.02, random);
  for (const double half_m : {0.2, 3.0}) {
    MatchProblem problem{room.grid, scan, {4, 3, 0.3}, {half_m, half_m, 0.2}};
    const double response = CorrelativeMatcher({}).match(problem).response;
    problem.min_response = response;
    EXPECT_TRUE(CorrelativeMatcher({}).match(problem).found) << "the smallest response is just reached";
    problem.min_response = response + 1e-6;
    const MatchResult match = CorrelativeMatcher({}).match(problem);
    EXPECT_FALSE(match.found);
    EXPECT_GT(match.evaluations, 0);
    EXPECT_GT(match.window.n_x, 0) << "the result holds the searched window also without a match";
  }
}

TEST(CorrelativeMatcher, one_room_is_not_ambiguous) {
  const Room room;
  std::mt19937_64 random(76);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 180, 0.01, random);
  MatchProblem problem{room.grid, scan, {4.3, 2.8, 0.2}, {8, 8, 0.5}};
  problem.measure_ambiguity = true;
  MatcherOptions options;
  const MatchResult match = CorrelativeMatcher(options).match(problem);
  ASSERT_TRUE(match.ambiguity);
  EXPECT_EQ(*match.ambiguity, 0) << "no distinct pose reaches the ambiguity floor";

  options.ambiguity_floor = 0.05;
  const MatchResult with_low_floor = CorrelativeMatcher(options).match(problem);
  EXPECT_GT(*with_low_floor.ambiguity, 0.05);
  EXPECT_LT(*with_low_floor.ambiguity, 0.6);
}

TEST(CorrelativeMatcher, two_equal_rooms_are_ambiguous) {
  SimulatedWalls rooms = furnished_room();
  const SimulatedWalls one = rooms;
  for (const auto& wall : one.walls) rooms.add_wall(wall.x0 + 12, wall.y0, wall.x1 + 12, wall.y1);
  const ScoreGrid grid = grid_of(rooms);
  std::mt19937_64 random(77);
  const ScanPoints scan = scan_of(one, {4, 3, 0.3}, 180, 0.01, random);
  // The window is centred between the rooms and contains both.
  MatchProblem problem{grid, scan, {10.3, 2.8, 0.2}, {8, 8, 0.5}};
  problem.measure_ambiguity = true;
  const MatchResult match = CorrelativeMatcher({}).match(problem);
  ASSERT_TRUE(match.ambiguity);
  EXPECT_GT(*match.ambiguity, 0.98);
  EXPECT_LE(*match.ambiguity, 1.0);

  // This window contains only one room.
  problem.map_T_robot = {4.3, 2.8, 0.2};
  problem.extent = {3, 3, 0.5};
  EXPECT_EQ(CorrelativeMatcher({}).match(problem).ambiguity, 0.0);
}

TEST(CorrelativeMatcher, the_next_best_peak_is_distinct) {
  const Room room;
  std::mt19937_64 random(78);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 60, 0.01, random);
  MatchProblem problem{room.grid, scan, {4, 3, 0.3}, {0.4, 0.4, 0.3}};
  problem.measure_ambiguity = true;
  MatcherOptions options;
  options.ambiguity_floor = 0;
  options.distinct_m = 0.3;
  options.distinct_rad = 0.1;
  const MatchResult match = CorrelativeMatcher(options).match(problem);

  const SearchLattice lattice(room.grid, scan, problem.map_T_robot, match.window);
  const std::optional<Candidate> best = slow_search(lattice, 0);
  const ExcludedRegion around = {best->pose, 6, static_cast<int>(0.1 / match.window.angular_step_rad)};
  const std::optional<Candidate> next = slow_search(lattice, 0, around);
  EXPECT_EQ(*match.ambiguity, static_cast<double>(next->sum) / best->sum);
}

TEST(CorrelativeMatcher, without_observations_every_pose_is_equal) {
  const Room room;
  std::mt19937_64 random(79);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 60, 0.01, random);
  MatchProblem problem{room.grid, scan, {400, 3, 0.3}, {1, 1, 0.3}};
  problem.measure_ambiguity = true;
  const MatchResult match = CorrelativeMatcher({}).match(problem);
  EXPECT_TRUE(match.found) << "every pose reaches a minimum response of 0";
  EXPECT_EQ(match.response, 0);
  EXPECT_EQ(match.map_T_robot.x, 400) << "the centre is the best of equal poses";
  EXPECT_EQ(match.map_T_robot.y, 3);
  EXPECT_NEAR(match.map_T_robot.phi, 0.3, 1e-12);
  EXPECT_EQ(match.ambiguity, 1.0);
  EXPECT_TRUE(match.covariance.allFinite());
}

TEST(CorrelativeMatcher, a_degenerate_window_is_an_error) {
  const Room room;
  const ScanPoints empty;
  const CorrelativeMatcher matcher({});
  EXPECT_THROW(matcher.match({room.grid, empty, {4, 3, 0}, {1, 1, 0.3}}), std::invalid_argument);
  std::mt19937_64 random(80);
  const ScanPoints scan = scan_of(room.walls, {4, 3, 0.3}, 60, 0.01, random);
  EXPECT_THROW(matcher.match({room.grid, scan, {4, 3, 0}, {0, 1, 0.3}}), std::invalid_argument);
}

TEST(CorrelativeMatcher, four_threads_give_the_same_results) {
  const Room room;
  const CorrelativeMatcher matcher({});
  std::mt19937_64 random(81);
  std::vector<ScanPoints> scans;
  for (int i = 0; i < 12; ++i)
    scans.push_back(scan_of(room.walls, {2.5 + 0.25 * i, 2.5, 0.4 * i}, 120, 0.02, random));
  const auto match_all = [&] {
    std::vector<MatchResult> results;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const auto k = static_cast<double>(i);
      const double half_m = i % 2 == 0 ? 0.3 : 1.5;
      MatchProblem problem{room.grid, scans[i], {2.6 + 0.25 * k, 2.4, 0.4 * k + 0.05}, {half_m, half_m, 0.3}};
      problem.measure_ambiguity = true;
      results.push_back(matcher.match(problem));
    }
    return results;
  };
  const std::vector<MatchResult> alone = match_all();
  std::vector<std::vector<MatchResult>> together(4);
  std::vector<std::thread> threads;
  for (auto& results : together) threads.emplace_back([&] { results = match_all(); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& results : together) {
    ASSERT_EQ(results.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i) expect_same_result(results[i], alone[i]);
  }
}

TEST(CorrelativeMatcher, is_named_as_in_the_settings) {
  EXPECT_EQ(CorrelativeMatcher({}).name(), "csm");
}

}  // namespace
}  // namespace psi_slam
