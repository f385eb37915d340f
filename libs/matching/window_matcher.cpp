// SPDX-License-Identifier: BSD-3-Clause
#include "matching/window_matcher.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

std::uint32_t smallest_sum(const SearchLattice& lattice, double response) {
  return static_cast<std::uint32_t>(std::ceil(std::clamp(response, 0.0, 1.0) * lattice.goal_max()));
}

// Returns the number of steps to a distance, rounded up. The tolerance keeps rounding errors from adding a
// step.
int steps_to(double distance, double step) {
  return std::max(1, static_cast<int>(std::ceil(distance / step - 1e-9)));
}

// Returns the ratio of the second-best sum to the best. If the best sum is 0, all poses are equal and the
// ratio is 1.
double ambiguity_of(const Candidate& best, const std::optional<Candidate>& next) {
  if (!next) return 0;
  return best.sum == 0 ? 1 : static_cast<double>(next->sum) / best.sum;
}

}  // namespace

void pick_peaks(const std::vector<Candidate>& scored, const PeakRequest& request, FoundPeaks& peaks) {
  const auto keep_best = [](std::optional<Candidate>& best, const Candidate& candidate) {
    if (!best || candidate.better_than(*best)) best = candidate;
  };
  for (const Candidate& candidate : scored)
    if (candidate.sum >= request.min_sum) keep_best(peaks.best, candidate);
  if (!peaks.best || !request.next) return;
  const ExcludedRegion around = {peaks.best->pose, request.next->cells, request.next->turns};
  const double least = request.next->share * peaks.best->sum;
  for (const Candidate& candidate : scored)
    if (candidate.sum >= least && !around.contains(candidate.pose)) keep_best(peaks.next, candidate);
}

MatchResult WindowMatcher::match(const MatchProblem& problem) const {
  MatchResult result;
  result.window = make_search_window(problem.extent, problem.grid.resolution_m(), problem.scan.farthest_m);
  const SearchLattice lattice(problem.grid, problem.scan, problem.map_T_robot, result.window);
  PeakRequest request;
  request.min_sum = smallest_sum(lattice, problem.min_response);
  request.seed = problem.seed;
  if (problem.measure_ambiguity)
    request.next = {steps_to(options_.distinct_m, result.window.linear_step_m),
                    steps_to(options_.distinct_rad, result.window.angular_step_rad),
                    options_.ambiguity_floor};
  const FoundPeaks peaks = find_peaks(lattice, request);
  result.search = peaks.search;
  result.evaluations = peaks.evaluations;
  if (!peaks.best) return result;

  result.found = true;
  result.lattice_pose = lattice.pose(peaks.best->pose);
  result.response = lattice.response(peaks.best->sum);
  const RefinedPose refined =
      refine(problem.grid, problem.scan, result.lattice_pose, options_.refinement, problem.prior);
  result.map_T_robot = refined.map_T_robot;
  result.refined_response = refined.mean_score;
  result.information = refined.information;
  result.covariance = bounded_covariance(refined.information, options_.min_sigma_m, options_.max_sigma_m,
                                         problem.scan.farthest_m);
  if (problem.measure_ambiguity) result.ambiguity = ambiguity_of(*peaks.best, peaks.next);
  return result;
}

}  // namespace psi_slam
