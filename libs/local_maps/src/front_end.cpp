// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/local_maps/front_end.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

double length_m(const TPose2D& motion) {
  return std::hypot(motion.x, motion.y);
}

MatcherOptions matcher_options(const FrontEndOptions& options) {
  MatcherOptions matcher;
  matcher.refinement = options.refinement;
  return matcher;
}

// How far odometry's motion and a steady robot's, that of the last step, are apart: a wheel that slips, an
// encoder that stalls or catches up, and a stamp that is late all show here.
struct Surprise {
  double m;
  double rad;
};

Surprise surprise(const TPose2D& motion, const TPose2D& last_motion) {
  return {std::hypot(motion.x - last_motion.x, motion.y - last_motion.y),
          std::abs(mrpt::math::wrapToPi(motion.phi - last_motion.phi))};
}

}  // namespace

FrontEnd::FrontEnd(const FrontEndOptions& options) : options_(options), matcher_(matcher_options(options)) {}

FrontEndStep FrontEnd::add(const Frame& frame) {
  FrontEndStep step;
  step.points = std::make_shared<const ScanPoints>(matching_points(frame.scan, options_.scan));
  const TPose2D motion = last_ ? frame.odom_T_robot - last_->odom_T_robot : TPose2D(0, 0, 0);
  step.local_T_robot = last_local_T_robot_ + motion;
  step.window = search_extent(motion);
  if (!active_.empty() && !step.points->points.empty()) match(step, motion);
  if (active_.empty() || moved_enough(step.local_T_robot)) insert(step, frame);
  last_ = Frame{frame.index, frame.time_us, frame.odom_T_robot, {}};
  last_motion_ = step.local_T_robot - last_local_T_robot_;
  last_local_T_robot_ = step.local_T_robot;
  misses_ = step.matched ? 0 : misses_ + 1;
  return step;
}

SearchExtent FrontEnd::search_extent(const TPose2D& motion) const {
  const Surprise off = surprise(motion, last_motion_);
  const double lost = 1 + misses_;
  const double half_m = lost * (options_.window_m + options_.window_per_metre * length_m(motion) + off.m);
  const double half_rad =
      lost * (options_.window_rad + options_.window_rad_per_metre * length_m(motion) +
              options_.window_per_radian * std::abs(mrpt::math::wrapToPi(motion.phi)) + off.rad);
  return {std::min(half_m, options_.max_window_m), std::min(half_m, options_.max_window_m),
          std::min(half_rad, options_.max_window_rad)};
}

PosePrior FrontEnd::prior(const TPose2D& map_T_robot, const TPose2D& motion) const {
  const Surprise off = surprise(motion, last_motion_);
  const double sigma_m = options_.prior_sigma_m + options_.prior_per_metre * length_m(motion) +
                         options_.prior_per_surprise * off.m;
  const double sigma_rad = options_.prior_sigma_rad +
                           options_.prior_per_radian * std::abs(mrpt::math::wrapToPi(motion.phi)) +
                           options_.prior_per_surprise * off.rad;
  PosePrior prior;
  prior.map_T_robot = map_T_robot;
  prior.information.diagonal() << 1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m),
      1 / (sigma_rad * sigma_rad);
  return prior;
}

void FrontEnd::match(FrontEndStep& step, const TPose2D& motion) {
  const PlacedLocalMap& older = active_.front();
  const Surprise off = surprise(motion, last_motion_);
  std::vector<TPose2D> motions = {motion};
  if (off.m > options_.max_window_m || off.rad > options_.max_window_rad) motions.push_back(last_motion_);
  std::optional<MatchResult> best;
  PosePrior best_prior;
  for (const TPose2D& hypothesis : motions) {
    const PosePrior prior = this->prior(last_local_T_robot_ + hypothesis - older.local_T_map, motion);
    MatchProblem problem{older.map->scores(), *step.points, prior.map_T_robot, step.window};
    problem.min_response = options_.min_response;
    problem.prior = prior;
    const MatchResult match = matcher_.match(problem);
    step.evaluations += match.evaluations;
    if (!match.found || (best && match.response <= best->response)) continue;
    best = match;
    best_prior = prior;
  }
  if (!best) return;
  step.matched = true;
  step.response = best->response;
  step.information = best->information;
  step.local_T_robot = older.local_T_map + best->map_T_robot;

  const RefinedPose predicted =
      refine(older.map->scores(), *step.points, best_prior.map_T_robot, options_.refinement, best_prior);
  if (predicted.mean_score >= options_.prediction_share * best->refined_response) {
    step.information = predicted.information;
    step.local_T_robot = older.local_T_map + predicted.map_T_robot;
  }
}

bool FrontEnd::moved_enough(const TPose2D& local_T_robot) const {
  const TPose2D motion = local_T_robot - last_node_local_T_robot_;
  return length_m(motion) >= options_.node_distance_m ||
         std::abs(mrpt::math::wrapToPi(motion.phi)) >= options_.node_rotation_rad;
}

void FrontEnd::begin_local_map(std::size_t node, const TPose2D& local_T_robot) {
  PlacedLocalMap begun;
  begun.id = next_local_map_++;
  begun.anchor = node;
  begun.local_T_map = local_T_robot;
  begun.first_node = node;
  begun.last_node = node;
  begun.map = std::make_shared<LocalMap>(options_.local_map);
  active_.push_back(std::move(begun));
}

void FrontEnd::insert(FrontEndStep& step, const Frame& frame) {
  const std::size_t node = next_node_++;
  step.node = node;
  const double moved_m = node == 0 ? 0 : length_m(step.local_T_robot - last_node_local_T_robot_);
  last_node_local_T_robot_ = step.local_T_robot;

  for (PlacedLocalMap& active : active_) {
    active.last_node = node;
    active.travelled_m += moved_m;
    step.memberships.push_back({active.id, active.anchor, step.local_T_robot - active.local_T_map});
  }
  const auto share = [&](const PlacedLocalMap& active) {
    return std::max(static_cast<double>(active.last_node - active.first_node) /
                        static_cast<double>(options_.nodes_per_local_map),
                    active.travelled_m / options_.local_map_travel_m);
  };
  if (active_.empty() || (active_.size() == 1 && share(active_.front()) >= 0.5))
    begin_local_map(node, step.local_T_robot);
  for (PlacedLocalMap& active : active_) {
    active.map->insert(drawing_beams(frame.scan, step.local_T_robot - active.local_T_map,
                                     options_.scan.min_range_m, options_.local_map.max_insert_range_m));
  }
  if (share(active_.front()) >= 1.0 && active_.size() > 1) {
    active_.front().map->finish();
    step.finished = active_.front();
    active_.erase(active_.begin());
    begin_local_map(node, step.local_T_robot);
    active_.back().map->insert(drawing_beams(frame.scan, TPose2D(0, 0, 0), options_.scan.min_range_m,
                                             options_.local_map.max_insert_range_m));
  }
}

std::vector<PlacedLocalMap> FrontEnd::finish() {
  std::vector<PlacedLocalMap> finished;
  for (PlacedLocalMap& active : active_) {
    active.map->finish();
    finished.push_back(active);
  }
  active_.clear();
  return finished;
}

}  // namespace psi_slam
