// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/correlative_matcher.h"

#include <algorithm>
#include <cmath>

#include "psi_slam/matching/branch_and_bound.h"
#include "psi_slam/matching/exhaustive_search.h"

namespace psi_slam {
namespace {

// Windows up to this many poses are searched exhaustively: there the pyramid costs more than it saves.
constexpr std::int64_t kExhaustivePoses = 60'000;

SearchOutcome search(const SearchLattice& lattice, std::uint32_t min_sum,
                     const std::optional<ExcludedRegion>& excluded = {}) {
  const SearchWindow& window = lattice.window();
  const std::int64_t poses =
      static_cast<std::int64_t>(2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
  const bool exhaustive = poses <= kExhaustivePoses || !lattice.grid().has_pyramid();
  return exhaustive ? exhaustive_search(lattice, min_sum, excluded)
                    : branch_and_bound_search(lattice, min_sum, excluded);
}

std::uint32_t smallest_sum(const SearchLattice& lattice, double response) {
  return static_cast<std::uint32_t>(std::ceil(std::clamp(response, 0.0, 1.0) * lattice.goal_max()));
}

// The least number of steps that reach a distance; one that is whole but for rounding stays whole.
int steps_to(double distance, double step) {
  return std::max(1, static_cast<int>(std::ceil(distance / step - 1e-9)));
}

// Where the best response is 0, every pose is as good as the best.
double ambiguity_of(const Candidate& best, const std::optional<Candidate>& next) {
  if (!next) return 0;
  return best.sum == 0 ? 1 : static_cast<double>(next->sum) / best.sum;
}

}  // namespace

MatchResult CorrelativeMatcher::match(const MatchProblem& problem) const {
  MatchResult result;
  result.window = make_search_window(problem.extent, problem.grid.resolution_m(), problem.scan.farthest_m);
  const SearchLattice lattice(problem.grid, problem.scan, problem.map_T_robot, result.window);
  const SearchOutcome outcome = search(lattice, smallest_sum(lattice, problem.min_response));
  result.evaluations = outcome.evaluations;
  if (!outcome.best) return result;

  result.found = true;
  result.lattice_pose = lattice.pose(outcome.best->pose);
  result.response = lattice.response(outcome.best->sum);
  const RefinedPose refined =
      refine(problem.grid, problem.scan, result.lattice_pose, options_.refinement, problem.prior);
  result.map_T_robot = refined.map_T_robot;
  result.refined_response = refined.mean_score;
  result.information = refined.information;
  result.covariance = bounded_covariance(refined.information, options_.min_sigma_m, options_.max_sigma_m,
                                         problem.scan.farthest_m);

  if (problem.measure_ambiguity) {
    const ExcludedRegion around = {outcome.best->pose,
                                   steps_to(options_.distinct_m, result.window.linear_step_m),
                                   steps_to(options_.distinct_rad, result.window.angular_step_rad)};
    const auto floor = smallest_sum(lattice, result.response * options_.ambiguity_floor);
    const SearchOutcome next = search(lattice, floor, around);
    result.evaluations += next.evaluations;
    result.ambiguity = ambiguity_of(*outcome.best, next.best);
  }
  return result;
}

}  // namespace psi_slam
