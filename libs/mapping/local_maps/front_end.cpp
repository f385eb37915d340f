// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/front_end.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/discarded_ranges.h"
#include "logs/frames/odometry_track.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/sweep_motion.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

double length_m(const TPose2D& motion) {
  return portable::hypot(motion.x, motion.y);
}

MatcherOptions matcher_options(const FrontEndOptions& options) {
  MatcherOptions matcher;
  matcher.refinement = options.refinement;
  return matcher;
}

constexpr double kHalfWeight_s = 0.5;  // time after which the disagreement with the last step counts half

// Returns the motion during the sweep of the first laser, which the poses of the frame refer to.
TPose2D motion_of_first_scan(const Frame& frame, const TPose2D& motion, double duration_s) {
  return motion_during_sweep(motion, duration_s, static_cast<double>(frame.scan.sweep_time_s))
      .value_or(TPose2D(0, 0, 0));
}

}  // namespace

FrontEnd::FrontEnd(const FrontEndOptions& options, bool draws_beside)
    : options_(options),
      younger_drawing_(std::make_unique<TaskThread>(draws_beside)),
      matcher_(matcher_options(options)),
      constant_velocity_(options.constant_velocity),
      doubtful_corrections_(options.doubtful_corrections) {}

FrontEndStep FrontEnd::add(const Frame& frame) {
  FrontEndStep step = track(frame);
  draw(step, step.straightened ? *step.straightened : frame);
  return step;
}

FrontEndStep FrontEnd::track(const Frame& frame, bool may_be_lost) {
  if (auto standing = step_of_standing_robot(frame)) return *std::move(standing);
  FrontEndStep step;
  const TPose2D during_sweep = straighten_by_prediction(frame, step);
  step.points = std::make_shared<const ScanPoints>(
      matching_points(step.straightened ? *step.straightened : frame, options_.scan));
  const Motion motion = motion_to(frame);
  doubtful_corrections_.moved(motion.length_m, motion.correction_sigma_m);
  step.local_T_robot = compose(last_local_T_robot_, motion.predicted);
  step.window = search_extent(motion);
  // Without a point farther than one cell from the robot, make_search_window() may throw.
  const bool blind =
      step.points->points.empty() || step.points->farthest_m <= options_.local_map.resolution_m;
  if (!active_.empty() && !blind) {
    const double expected_response = expected_response_;
    match(step, motion);
    step.lost = may_be_lost && is_lost(step, motion, frame.time_us, expected_response);
    if (step.lost) return step;
  }
  const TPose2D local_T_middle = compose(step.local_T_robot, interpolate({0, 0, 0}, during_sweep, 0.5));
  if (step.matched && misses_ == 0) straighten_by_match(frame, local_T_middle, step);
  const double travel_m = motion.measured ? motion.length_m : std::max(motion.length_m, motion.sigma_m);
  unmatched_travel_m_ = step.matched ? 0 : unmatched_travel_m_ + travel_m;
  propagate_covariances(step, motion);
  if (!last_ || last_->has_odometry != frame.has_odometry || !(last_->odom_T_robot == frame.odom_T_robot))
    unchanged_odometry_local_T_robot_ = step.local_T_robot;
  last_ = Frame{frame.index, frame.time_us, frame.odom_T_robot, {}, frame.has_odometry};
  // A wrong prediction bends a scan about the middle of its sweep, where the match is therefore right. Speeds
  // from the poses at the beginnings of sweeps would amplify the errors of predictions.
  const bool in_mid_sweep = !frame.has_odometry && frame.scan.sweep_time_s != 0;
  constant_velocity_.moved(frame.time_us, local_T_middle, step.matched, frame.imu_heading_rad, in_mid_sweep);
  last_local_T_middle_ = local_T_middle;
  last_motion_ = between(last_local_T_robot_, step.local_T_robot);
  last_predicted_motion_ = motion.predicted;
  last_local_T_robot_ = step.local_T_robot;
  misses_ = step.matched ? 0 : misses_ + 1;
  step.misplaced = !active_.empty() && !step.matched && !has_left_local_maps() &&
                   contradicts(*step.points, step.local_T_robot, kLeastAgreement);
  if (becomes_node(step)) step.node = next_node_++;
  standstill_.add(frame, step.local_T_robot, step.matched);
  return step;
}

// The step and the state after it depend on the time, the odometry and the gyroscope of the frame, but not on
// its ranges. So they stay the same when the ranges are discarded.
std::optional<FrontEndStep> FrontEnd::step_of_standing_robot(const Frame& frame) {
  if (active_.empty() || !standstill_.is_long(frame) || constant_velocity_.is_gap(frame.time_us)) return {};
  FrontEndStep step;
  step.points = std::make_shared<const ScanPoints>(matching_points(frame, options_.scan));
  const bool is_discarded = !has_ranges(frame);
  if (is_discarded) standstill_.skip();
  if (!is_discarded && !fits_standstill(*step.points)) return {};
  step.local_T_robot = standstill_.place();
  step.matched = true;
  step.stands = true;
  step.repeats = is_discarded || !standstill_.keeps(frame.time_us);
  step.response = expected_response_;
  // The odometry stays, so that the next motion includes what odometry moved during the standstill.
  last_->index = frame.index;
  last_->time_us = frame.time_us;
  constant_velocity_.moved(frame.time_us, step.local_T_robot, true, frame.imu_heading_rad);
  last_local_T_middle_ = last_local_T_robot_ = step.local_T_robot;
  last_motion_ = {0, 0, 0};
  misses_ = 0;
  unmatched_travel_m_ = 0;
  return step;
}

// Returns whether a scan fits the older active map at the place where the robot stands.
bool FrontEnd::fits_standstill(const ScanPoints& scan) {
  if (scan.points.empty()) return false;
  const PlacedLocalMap& older = active_.front();
  const PosePrior here = prior(between(older.local_T_map, standstill_.place()), {});
  const RefinedPose refined = refine(older.map->scores(), scan, here.map_T_robot, options_.refinement, here);
  return refined.mean_score >= options_.min_response_share * expected_response_ &&
         standstill_.confirm(compose(older.local_T_map, refined.map_T_robot));
}

TPose2D FrontEnd::straighten_by_prediction(const Frame& frame, FrontEndStep& step) const {
  if (frame.has_odometry) return {0, 0, 0};
  const PredictedMotion predicted = constant_velocity_.predict(frame.time_us, frame.imu_heading_rad);
  Frame still = frame;
  if (!straighten(still, predicted.motion, predicted.duration_s)) return {0, 0, 0};
  step.straightened = std::move(still);
  return motion_of_first_scan(frame, predicted.motion, predicted.duration_s);
}

void FrontEnd::straighten_by_match(const Frame& frame, const TPose2D& local_T_middle,
                                   FrontEndStep& step) const {
  if (frame.has_odometry || !last_ || last_->has_odometry) return;
  const TPose2D motion = between(last_local_T_middle_, local_T_middle);
  const double duration_s = constant_velocity_.predict(frame.time_us).duration_s;
  Frame still = frame;
  if (!straighten(still, motion, duration_s)) return;
  const TPose2D during_sweep = motion_of_first_scan(frame, motion, duration_s);
  step.local_T_robot = compose(local_T_middle, inverse(interpolate({0, 0, 0}, during_sweep, 0.5)));
  step.points = std::make_shared<const ScanPoints>(matching_points(still, options_.scan));
  step.straightened = std::move(still);
}

FrontEnd::Motion FrontEnd::motion_to(const Frame& frame) const {
  Motion motion;
  if (!last_) return motion;
  if (!frame.has_odometry || !last_->has_odometry || has_frozen_odometry(frame))
    return constant_velocity_motion(frame);
  if (was_restarted(last_->odom_T_robot, frame.odom_T_robot)) {
    motion = constant_velocity_motion(frame);
    motion.was_restarted = true;
    return motion;
  }
  motion.predicted = between(last_->odom_T_robot, frame.odom_T_robot);
  motion.length_m = portable::hypot(motion.predicted.x, motion.predicted.y);
  motion.turn_rad = std::abs(mrpt::math::wrapToPi(motion.predicted.phi));
  const double passed_s = std::max(0.0, seconds(frame.time_us - last_->time_us));
  // The variances of independent errors add up, so the sum does not depend on the rate of scans.
  const auto variance = [&](double rest, double per_metre, double per_radian) {
    return rest * rest * passed_s + per_metre * per_metre * motion.length_m +
           per_radian * per_radian * motion.turn_rad;
  };
  motion.sigma_m = std::sqrt(variance(options_.odometry_sigma_m, options_.odometry_sigma_per_metre,
                                      options_.odometry_sigma_per_radian));
  motion.sigma_rad = std::sqrt(variance(options_.odometry_sigma_rad, options_.odometry_sigma_rad_per_metre,
                                        options_.odometry_sigma_rad_per_radian));
  const double elapsed = passed_s / kHalfWeight_s;
  const double weight = 1 / (1 + elapsed * elapsed);
  motion.disagreement_m = weight * distance_m(last_motion_, motion.predicted);
  motion.disagreement_rad = weight * std::abs(mrpt::math::wrapToPi(motion.predicted.phi - last_motion_.phi));
  motion.wide_disagreement_rad = motion.disagreement_rad;
  // Compared with odometry only: a wrong match must not make the next wrong correction plausible.
  const double uneven_m = distance_m(last_predicted_motion_, motion.predicted);
  motion.correction_sigma_m = portable::hypot(
      motion.sigma_m, options_.prior_per_surprise * std::min(uneven_m, motion.disagreement_m));
  motion.after_gap = constant_velocity_.is_gap(frame.time_us);
  return motion;
}

bool FrontEnd::has_frozen_odometry(const Frame& frame) const {
  if (!(frame.odom_T_robot == last_->odom_T_robot)) return false;
  const TPose2D motion = between(unchanged_odometry_local_T_robot_, last_local_T_robot_);
  return length_m(motion) > options_.window_m ||
         std::abs(mrpt::math::wrapToPi(motion.phi)) > options_.window_rad;
}

FrontEnd::Motion FrontEnd::constant_velocity_motion(const Frame& frame) const {
  const PredictedMotion predicted = constant_velocity_.predict(frame.time_us, frame.imu_heading_rad);
  Motion motion;
  motion.measured = false;
  motion.predicted = predicted.motion;
  motion.length_m = portable::hypot(motion.predicted.x, motion.predicted.y);
  motion.turn_rad = std::abs(motion.predicted.phi);
  motion.disagreement_m = predicted.sigma_since_match_m;
  motion.disagreement_rad = predicted.sigma_since_match_rad;
  motion.wide_disagreement_rad = predicted.sigma_without_gyroscope_rad;
  motion.sigma_m = predicted.sigma_m;
  motion.sigma_rad = predicted.sigma_rad;
  motion.after_gap = constant_velocity_.is_gap(frame.time_us);
  return motion;
}

// Propagates the pose covariance in each active map by a Kalman filter: the motion adds the noise of
// odometry, and the match reduces the covariance. Where only odometry determines the position, as along a
// corridor, the covariance grows.
void FrontEnd::propagate_covariances(const FrontEndStep& step, const Motion& motion) {
  const auto propagate = [&](const TPose2D& local_T_origin, Eigen::Matrix3d& covariance) {
    const TPose2D before = between(local_T_origin, last_local_T_robot_);
    const TPose2D after = between(local_T_origin, step.local_T_robot);
    Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();
    moved(0, 2) = -(after.y - before.y);
    moved(1, 2) = after.x - before.x;
    covariance = Eigen::Matrix3d(moved * covariance * moved.transpose());
    covariance.diagonal() += Eigen::Vector3d(motion.sigma_m * motion.sigma_m, motion.sigma_m * motion.sigma_m,
                                             motion.sigma_rad * motion.sigma_rad);
    if (!step.matched) return;
    // Rotation from the axes of the matched map to those of the origin.
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = rotation_matrix(active_.front().local_T_map.phi - local_T_origin.phi);
    const Eigen::Matrix3d information = turn * step.information * turn.transpose();
    covariance =
        Eigen::Matrix3d((Eigen::Matrix3d::Identity() + covariance * information).inverse() * covariance);
    covariance = Eigen::Matrix3d(0.5 * (covariance + covariance.transpose()));
  };
  for (PlacedLocalMap& active : active_) propagate(active.local_T_map, active.covariance);
  propagate(last_node_local_T_robot_, covariance_since_node_);
}

bool FrontEnd::moved_enough(const TPose2D& local_T_robot) const {
  const TPose2D motion = between(last_node_local_T_robot_, local_T_robot);
  return length_m(motion) >= options_.node_distance_m ||
         std::abs(mrpt::math::wrapToPi(motion.phi)) >= options_.node_rotation_rad;
}

bool FrontEnd::becomes_node(const FrontEndStep& step) const {
  return active_.empty() || (moved_enough(step.local_T_robot) && !step.misplaced);
}

bool FrontEnd::has_left_local_maps() const {
  return (unmatched_travel_m_ >= options_.max_unmatched_travel_m && misses_ > 1) ||
         unmatched_travel_m_ >= options_.local_map_travel_m;
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

void FrontEnd::end_local_maps(FrontEndStep& step, std::size_t count) {
  const auto end = active_.begin() + static_cast<std::ptrdiff_t>(count);
  for (auto active = active_.begin(); active != end; ++active) {
    active->map->finish();
    step.finished.push_back(*active);
  }
  active_.erase(active_.begin(), end);
}

const std::vector<PlacedLocalMap>& FrontEnd::active() const {
  younger_drawing_->wait();
  return active_;
}

void FrontEnd::draw(FrontEndStep& step, const Frame& frame) {
  if (!step.node) return;
  younger_drawing_->wait();
  const std::size_t node = *step.node;
  const double moved_m = node == 0 ? 0 : length_m(between(last_node_local_T_robot_, step.local_T_robot));
  last_node_local_T_robot_ = step.local_T_robot;
  step.covariance_since_node = std::exchange(covariance_since_node_, Eigen::Matrix3d::Zero());

  for (const PlacedLocalMap& active : active_)
    step.memberships.push_back(
        {active.id, active.anchor, between(active.local_T_map, step.local_T_robot), active.covariance});
  if (has_left_local_maps()) {
    end_local_maps(step, active_.size());
    unmatched_travel_m_ = 0;
  }
  for (PlacedLocalMap& active : active_) {
    active.last_node = node;
    active.travelled_m += moved_m;
  }
  const auto share = [&](const PlacedLocalMap& active) {
    return std::max(static_cast<double>(active.last_node - active.first_node) /
                        static_cast<double>(options_.nodes_per_local_map),
                    active.travelled_m / options_.local_map_travel_m);
  };
  if (active_.empty() || (active_.size() == 1 && share(active_.front()) >= 0.5))
    begin_local_map(node, step.local_T_robot);
  const DrawingOptions drawing = {options_.local_map.max_insert_range_m,
                                  options_.local_map.smoothing_sigma_m};
  const auto insertion = [&](const PlacedLocalMap& active) {
    return [map = active.map, frame, map_T_robot = between(active.local_T_map, step.local_T_robot), drawing] {
      map->insert(drawing_beams(frame, map_T_robot, drawing));
    };
  };
  if (active_.size() > 1) younger_drawing_->start(insertion(active_.back()));
  insertion(active_.front())();
  if (share(active_.front()) >= 1.0 && active_.size() > 1) {
    younger_drawing_->wait();
    end_local_maps(step, 1);
    begin_local_map(node, step.local_T_robot);
    insertion(active_.back())();
  }
  active_.front().map->scores();  // updated now, so that the match of the next scan need not wait for it
}

void FrontEnd::begin_run() {
  FrontEnd next(options_);
  next.younger_drawing_ = std::move(younger_drawing_);
  next.next_local_map_ = next_local_map_;
  next.next_node_ = next_node_;
  *this = std::move(next);
}

std::vector<PlacedLocalMap> FrontEnd::finish() {
  younger_drawing_->wait();
  FrontEndStep step;
  end_local_maps(step, active_.size());
  return step.finished;
}

}  // namespace psi_slam
