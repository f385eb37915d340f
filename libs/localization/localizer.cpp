// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/localizer.h"

#include <cmath>
#include <utility>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Refined straight from the prediction, a pose that scores this share of the searched one is preferred: along
// a corridor the search's best is decided by noise.
constexpr double kPredictionShare = 0.95;

}  // namespace

Localizer::Localizer(ReferenceMap map, const LocalizerOptions& options)
    : options_(options),
      search_(std::move(map), options.search),
      matcher_(options.search.match),
      front_end_(options.front_end),
      consensus_(options.consensus) {
  map_frame_.add_node({0, 0, 0});
}

void Localizer::start_at(const TPose2D& map_T_robot) {
  map_T_local_ = map_T_robot;
  near_told_start_ = true;
}

LocalizationStep Localizer::add(const Frame& frame) {
  const FrontEndStep motion = front_end_->add(frame);
  LocalizationStep step;
  step.time_us = now_us_ = frame.time_us;
  const TPose2D moved = motion.local_T_robot - last_local_T_robot_;
  step.moved_m = std::hypot(moved.x, moved.y);
  last_local_T_robot_ = motion.local_T_robot;
  if (tracking()) {
    track(motion, step);
  } else if (motion.node) {
    remember_node(motion, frame.index, memory_);
    if (begins_stretch(memory_.nodes.size() - 1, memory_.nodes, options_.search_travel_m))
      search(frame.index, step);
  }
  return step;
}

void Localizer::track(const FrontEndStep& motion, LocalizationStep& step) {
  step.state = LocalizationStep::State::kTracking;
  step.map_T_robot = *map_T_local_ + motion.local_T_robot;
  step.fits = match_near(motion, step);
  if (fitted_us_ == 0) fitted_us_ = now_us_;
  if (step.fits) {
    map_T_local_ = step.map_T_robot + inverse(motion.local_T_robot);
    near_told_start_ = false;
    misfit_m_ = 0;
    fitted_us_ = now_us_;
    return;
  }
  misfit_m_ += step.moved_m;
  if (misfit_m_ <= options_.max_misfit_m && seconds(now_us_ - fitted_us_) <= options_.max_misfit_s) return;
  step.state = LocalizationStep::State::kLost;
  find_again();
}

PosePrior Localizer::prior_at(const TPose2D& map_T_robot) const {
  const double information_m = 1 / (options_.prior_sigma_m * options_.prior_sigma_m);
  const double information_rad = 1 / (options_.prior_sigma_rad * options_.prior_sigma_rad);
  PosePrior prior;
  prior.map_T_robot = map_T_robot;
  prior.information.diagonal() << information_m, information_m, information_rad;
  return prior;
}

bool Localizer::match_near(const FrontEndStep& motion, LocalizationStep& step) const {
  const LocalMap& map = *search_.map().fine;
  const ScanPoints& scan = *motion.points;
  if (scan.points.empty() || scan.farthest_m <= map.scores().resolution_m()) return false;
  const SearchExtent window =
      near_told_start_
          ? SearchExtent{options_.start_window_m, options_.start_window_m, options_.start_window_rad}
          : SearchExtent{options_.window_m, options_.window_m, options_.window_rad};
  MatchProblem problem{map.scores(), scan, step.map_T_robot, window};
  problem.min_response = options_.min_response;
  if (!near_told_start_) problem.prior = prior_at(step.map_T_robot);
  const MatchResult match = matcher_.match(problem);
  if (!match.found) return false;
  TPose2D matched = match.map_T_robot;
  if (problem.prior) {
    const RefinedPose predicted =
        refine(map.scores(), scan, step.map_T_robot, options_.search.match.refinement, problem.prior);
    if (predicted.mean_score >= kPredictionShare * match.refined_response) matched = predicted.map_T_robot;
  }
  const LocalMap::Agreement agreement = map.agreement(scan, matched);
  const auto points = static_cast<double>(scan.points.size());
  if (static_cast<double>(agreement.observed) < options_.min_observed_share * points ||
      agreement.share() < options_.min_agree)
    return false;
  step.map_T_robot = matched;
  step.response = match.response;
  step.confidence = static_cast<double>(agreement.hits) / points;
  return true;
}

void Localizer::search(std::size_t frame, LocalizationStep& step) {
  const std::size_t node = memory_.nodes.size() - 1;
  const NodeScan& here = memory_.nodes[node];
  const FoundPlace& place = step.search.emplace(search_.find(node, memory_, {options_.seed, frame, 0}));
  if (!place.believed()) return;
  const LoopConsensus::Vote vote{node, here.travelled_m,  here.local_T_robot,
                                 0,    place.map_T_robot, place.ambiguity};
  if (consensus_.add(vote, map_frame_).empty()) return;
  map_T_local_ = place.map_T_robot + inverse(here.local_T_robot);
  misfit_m_ = 0;
  fitted_us_ = now_us_;
  step.state = LocalizationStep::State::kTracking;
  step.map_T_robot = place.map_T_robot;
  step.fits = true;
  step.response = place.response;
  step.confidence = place.agree * place.observed_share;
}

// What the front end knows of the way until now may lead from where the robot is no more.
void Localizer::find_again() {
  map_T_local_.reset();
  near_told_start_ = false;
  front_end_.emplace(options_.front_end);
  last_local_T_robot_ = {0, 0, 0};
  memory_ = {};
  consensus_ = LoopConsensus(options_.consensus);
}

}  // namespace psi_slam
