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

PosePrior prior_at(const TPose2D& map_T_robot, const FrontEndOptions& options) {
  PosePrior prior;
  prior.map_T_robot = map_T_robot;
  const double along = 1 / (options.prior_sigma_m * options.prior_sigma_m);
  const double turned = 1 / (options.prior_sigma_rad * options.prior_sigma_rad);
  prior.information.diagonal() << along, along, turned;
  return prior;
}

}  // namespace

FrontEnd::FrontEnd(const FrontEndOptions& options) : options_(options), matcher_(matcher_options(options)) {}

FrontEndStep FrontEnd::add(const Frame& frame) {
  FrontEndStep step;
  step.points = std::make_shared<const ScanPoints>(matching_points(frame.scan, options_.scan));
  const TPose2D predicted = predict(frame);
  step.window = window_after(predicted - last_local_T_robot_);
  step.local_T_robot = predicted;
  if (!active_.empty() && !step.points->points.empty()) match(step, predicted);
  if (active_.empty() || moved_enough(step.local_T_robot)) insert(step, frame);
  last_ = Frame{frame.index, frame.time_us, frame.odom_T_robot, {}};
  last_local_T_robot_ = step.local_T_robot;
  return step;
}

TPose2D FrontEnd::predict(const Frame& frame) const {
  if (!last_) return TPose2D(0, 0, 0);
  return last_local_T_robot_ + (frame.odom_T_robot - last_->odom_T_robot);
}

SearchExtent FrontEnd::window_after(const TPose2D& motion) const {
  const double moved_m = length_m(motion);
  const double turned = std::abs(mrpt::math::wrapToPi(motion.phi));
  const double half_m =
      std::min(options_.max_window_m, options_.window_m + options_.window_per_metre * moved_m);
  return {half_m, half_m,
          std::min(options_.max_window_rad, options_.window_rad + options_.window_per_radian * turned +
                                                options_.window_rad_per_metre * moved_m)};
}

void FrontEnd::match(FrontEndStep& step, const TPose2D& predicted) const {
  const ActiveLocalMap& older = active_.front();
  const TPose2D map_T_predicted = predicted - older.local_T_map;
  MatchProblem problem{older.map->scores(), *step.points, map_T_predicted, step.window};
  problem.min_response = options_.min_response;
  problem.prior = prior_at(map_T_predicted, options_);
  const MatchResult match = matcher_.match(problem);
  step.evaluations = match.evaluations;
  if (!match.found) return;
  step.matched = true;
  step.response = match.response;
  step.information = match.information;
  step.local_T_robot = older.local_T_map + match.map_T_robot;
}

bool FrontEnd::moved_enough(const TPose2D& local_T_robot) const {
  const TPose2D motion = local_T_robot - last_node_local_T_robot_;
  return length_m(motion) >= options_.node_distance_m ||
         std::abs(mrpt::math::wrapToPi(motion.phi)) >= options_.node_rotation_rad;
}

void FrontEnd::begin_local_map(std::size_t node, const TPose2D& local_T_robot) {
  ActiveLocalMap begun;
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

  for (ActiveLocalMap& active : active_) {
    active.last_node = node;
    active.travelled_m += moved_m;
    step.memberships.push_back({active.id, active.anchor, step.local_T_robot - active.local_T_map});
  }
  const auto share = [&](const ActiveLocalMap& active) {
    return std::max(static_cast<double>(active.last_node - active.first_node) /
                        static_cast<double>(options_.nodes_per_local_map),
                    active.travelled_m / options_.local_map_travel_m);
  };
  if (active_.empty() || (active_.size() == 1 && share(active_.front()) >= 0.5))
    begin_local_map(node, step.local_T_robot);
  for (ActiveLocalMap& active : active_) {
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

std::vector<ActiveLocalMap> FrontEnd::finish() {
  std::vector<ActiveLocalMap> finished;
  for (ActiveLocalMap& active : active_) {
    active.map->finish();
    finished.push_back(active);
  }
  active_.clear();
  return finished;
}

}  // namespace psi_slam
