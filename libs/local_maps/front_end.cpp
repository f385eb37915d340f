// SPDX-License-Identifier: BSD-3-Clause
#include "local_maps/front_end.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "frames/discarded_ranges.h"
#include "frames/odometry_track.h"
#include "frames/pose_operations.h"
#include "frames/sweep_motion.h"
#include "local_maps/correction_support.h"

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

constexpr double kResponseWeight = 0.2;  // weight of one scan in the expected response
constexpr double kLeastExpected = 0.25;  // lower bound of the expected response
constexpr double kWiderBy = 1.5;         // smallest ratio of wide to narrow half-widths for a wide search
constexpr double kHalfWeight_s = 0.5;    // time after which the disagreement with the last step counts half
// Limits for the search of a wide window: number of points, and the farthest distance from which the heading
// step is computed. The match is then refined with all points.
constexpr std::size_t kCoarsePoints = 120;
constexpr double kCoarseFarthest_m = 30;

constexpr double kJudgedShare = 0.2;  // smallest share of a scan in observed space that can contradict a map
// After a gap, share of the expected response that a match needs if the robot did not move as predicted.
constexpr double kSureShare = 0.6;
// After an interruption, shares of the points in observed space that must fit it: at the matched pose, and at
// a pose that was only predicted.
constexpr double kLeastMatchedAgreement = 0.85;
constexpr double kLeastAgreement = 0.5;
constexpr int kLostMisses = 5;      // the robot may be lost after this many successive scans without a match
constexpr double kLostAfter_s = 5;  // and this time

// Returns at most kCoarsePoints points of a scan, at even steps of the index, for the search of a wide
// window.
ScanPoints coarse_scan(const ScanPoints& scan) {
  ScanPoints coarse;
  coarse.farthest_m = std::min(scan.farthest_m, kCoarseFarthest_m);
  const std::size_t step = (scan.points.size() + kCoarsePoints - 1) / kCoarsePoints;
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    coarse.points.push_back(scan.points[i]);
    if (!scan.normals.empty()) coarse.normals.push_back(scan.normals[i]);
  }
  return coarse;
}

// Returns the score of a pose for a comparison, of TrackedPoints::judged.
double judged_score(const ScoreGrid& grid, const ScanPoints& judged, const RefinedPose& pose) {
  return judged.points.empty() ? pose.mean_score : mean_score(grid, judged, pose.map_T_robot);
}

// Returns the motion during the sweep of the first laser, which the poses of the frame refer to.
TPose2D motion_of_first_scan(const Frame& frame, const TPose2D& motion, double duration_s) {
  return motion_during_sweep(motion, duration_s, static_cast<double>(frame.scan.sweep_time_s))
      .value_or(TPose2D(0, 0, 0));
}

}  // namespace

FrontEnd::FrontEnd(const FrontEndOptions& options)
    : options_(options),
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
  if (active_.empty() || moved_enough(step.local_T_robot)) step.node = next_node_++;
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
  if (!frame.has_odometry || !last_->has_odometry) return constant_velocity_motion(frame);
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
  motion.disagreement_m =
      weight * portable::hypot(motion.predicted.x - last_motion_.x, motion.predicted.y - last_motion_.y);
  motion.disagreement_rad = weight * std::abs(mrpt::math::wrapToPi(motion.predicted.phi - last_motion_.phi));
  motion.wide_disagreement_rad = motion.disagreement_rad;
  // Compared with odometry only: a wrong match must not make the next wrong correction plausible.
  const double uneven_m = portable::hypot(motion.predicted.x - last_predicted_motion_.x,
                                          motion.predicted.y - last_predicted_motion_.y);
  motion.correction_sigma_m = portable::hypot(
      motion.sigma_m, options_.prior_per_surprise * std::min(uneven_m, motion.disagreement_m));
  motion.after_gap = constant_velocity_.is_gap(frame.time_us);
  return motion;
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

SearchExtent FrontEnd::search_extent(const Motion& motion) const {
  const double widening = 1 + misses_;  // grows with each successive scan without a match
  const double half_m =
      widening * (options_.window_m + options_.window_per_metre * motion.length_m + motion.disagreement_m);
  const double half_rad = widening * (options_.window_rad + options_.window_rad_per_metre * motion.length_m +
                                      options_.window_per_radian * motion.turn_rad + motion.disagreement_rad);
  return {std::min(half_m, options_.max_window_m), std::min(half_m, options_.max_window_m),
          std::min(half_rad, options_.max_window_rad)};
}

PosePrior FrontEnd::prior(const TPose2D& map_T_robot, const Motion& motion) const {
  const double sigma_m = options_.prior_sigma_m + options_.prior_per_metre * motion.length_m +
                         options_.prior_per_surprise * motion.disagreement_m;
  const double sigma_rad = options_.prior_sigma_rad + options_.prior_per_radian * motion.turn_rad +
                           options_.prior_per_surprise * motion.disagreement_rad;
  PosePrior prior;
  prior.map_T_robot = map_T_robot;
  prior.information.diagonal() << 1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m),
      1 / (sigma_rad * sigma_rad);
  return prior;
}

// Returns a window for large errors of odometry. The error can be twice the motion, for example if odometry
// reports a reversal as forward motion.
SearchExtent FrontEnd::wide_extent(const Motion& motion) const {
  const double half_m =
      std::min(options_.max_wide_window_m,
               options_.window_m + options_.wide_window_per_motion * motion.length_m + motion.disagreement_m);
  const double half_rad =
      std::min(motion.measured ? options_.max_wide_window_rad : M_PI,
               options_.window_rad + motion.wide_disagreement_rad +
                   options_.wide_window_per_motion *
                       (motion.turn_rad + options_.window_rad_per_metre * motion.length_m));
  return {half_m, half_m, half_rad};
}

MatchResult FrontEnd::search(FrontEndStep& step, const ScanPoints& scan, const ScoreGrid& grid,
                             const PosePrior& prior, const SearchExtent& window, double min_response) const {
  MatchProblem problem{grid, scan, prior.map_T_robot, window};
  problem.min_response = min_response;
  problem.prior = prior;
  const MatchResult match = matcher_.match(problem);
  step.evaluations += match.evaluations;
  return match;
}

/// Searches the wide window. Stores the window in step.window if it contains a match. Returns nothing if the
/// window is hardly wider than step.window, or if no response reaches the limit of wide_response_gain.
std::optional<MatchResult> FrontEnd::search_widely(FrontEndStep& step, const Motion& motion,
                                                   double poor_response) {
  SearchExtent wide = wide_extent(motion);
  if (wide.x_m <= kWiderBy * step.window.x_m && wide.theta_rad <= kWiderBy * step.window.theta_rad) return {};
  wide = {std::max(wide.x_m, step.window.x_m), std::max(wide.y_m, step.window.y_m),
          std::max(wide.theta_rad, step.window.theta_rad)};
  const PlacedLocalMap& older = active_.front();
  PosePrior unknown;
  unknown.map_T_robot = between(older.local_T_map, compose(last_local_T_robot_, motion.predicted));
  const double needed = std::max(
      options_.wide_response_gain * std::max(poor_response, options_.min_response_share * expected_response_),
      motion.after_gap ? kSureShare * expected_response_ : 0.0);
  const ScoreGrid& grid = older.map->scores();
  MatchResult match = search(step, coarse_scan(*step.points), grid, unknown, wide, needed);
  if (!match.found) return {};
  const RefinedPose refined = refine(grid, *step.points, match.map_T_robot, options_.refinement, unknown);
  if (refined.mean_score < needed) return {};
  match.map_T_robot = refined.map_T_robot;
  match.refined_response = refined.mean_score;
  match.information = refined.information;
  step.window = wide;
  return match;
}

// Returns the motions that the robot may have made since the last scan. After a gap it may have stood still.
// If odometry disagrees strongly with the last motion, the robot may have continued as before.
std::vector<TPose2D> FrontEnd::hypotheses(const Motion& motion) const {
  const bool jumps =
      motion.disagreement_m > options_.max_window_m || motion.disagreement_rad > options_.max_window_rad;
  std::vector<TPose2D> hypotheses = {motion.predicted};
  if (motion.after_gap && !(motion.predicted == TPose2D(0, 0, 0))) hypotheses.emplace_back(0, 0, 0);
  if (jumps) hypotheses.push_back(last_motion_);
  return hypotheses;
}

// Returns whether too small a share of the scan fits the older active map at this pose, in space that the map
// has observed. False if the map has observed little of this space.
bool FrontEnd::contradicts(const ScanPoints& scan, const TPose2D& local_T_robot,
                           double least_agreement) const {
  const PlacedLocalMap& older = active_.front();
  const LocalMap::Agreement agreement = older.map->agreement(scan, between(older.local_T_map, local_T_robot));
  return static_cast<double>(agreement.observed) >= kJudgedShare * static_cast<double>(scan.points.size()) &&
         agreement.share() < least_agreement;
}

// Returns whether odometry states that the robot has left the place of the last scan that was drawn. If it
// has stalled instead, all points must show that the robot moved.
bool FrontEnd::has_left_last_node(const Motion& motion) const {
  return length_m(between(last_node_local_T_robot_, compose(last_local_T_robot_, motion.predicted))) >=
         options_.local_map.smoothing_sigma_m;
}

bool FrontEnd::is_lost(const FrontEndStep& step, const Motion& motion, TimeUs time_us,
                       double expected_response) const {
  const bool interrupted = motion.after_gap || motion.was_restarted;
  const bool mismatches =
      !step.matched && misses_ >= kLostMisses && constant_velocity_.unmatched_s(time_us) >= kLostAfter_s;
  if (!interrupted && !mismatches) return false;
  if (step.matched)
    return step.response < options_.poor_response_share * expected_response &&
           contradicts(*step.points, step.local_T_robot, kLeastMatchedAgreement);
  for (const TPose2D& hypothesis : hypotheses(motion))
    if (!contradicts(*step.points, compose(last_local_T_robot_, hypothesis), kLeastAgreement)) return false;
  return true;
}

void FrontEnd::match(FrontEndStep& step, const Motion& motion) {
  const PlacedLocalMap& older = active_.front();
  const ScoreGrid& grid = older.map->scores();
  const bool is_along_walls = options_.along_walls && has_left_last_node(motion);
  const TrackedPoints along_walls = is_along_walls ? points_along_walls(*step.points) : TrackedPoints();
  const ScanPoints& points = is_along_walls ? along_walls.matched : *step.points;
  const ScanPoints& judged = along_walls.judged;
  MatchResult best;
  PosePrior best_prior;
  const std::vector<TPose2D> tested = hypotheses(motion);
  for (const TPose2D& hypothesis : tested) {
    const PosePrior prior =
        this->prior(between(older.local_T_map, compose(last_local_T_robot_, hypothesis)), motion);
    const bool is_prediction = &hypothesis == &tested.front();
    const double least_share = motion.after_gap && !is_prediction
                                   ? std::max(options_.min_response_share, kSureShare)
                                   : options_.min_response_share;
    const MatchResult match =
        search(step, points, grid, prior, step.window, least_share * expected_response_);
    if (!match.found || (best.found && match.response <= best.response)) continue;
    best = match;
    best_prior = prior;
    if (motion.after_gap && is_prediction &&
        best.response >= options_.poor_response_share * expected_response_)
      break;
  }
  std::optional<MatchResult> wide;
  if (best.response < options_.poor_response_share * expected_response_)
    wide = search_widely(step, motion, best.response);
  if (wide) best = *wide;
  expected_response_ =
      std::max(kLeastExpected, expected_response_ + kResponseWeight * (best.response - expected_response_));
  if (!best.found) return;

  RefinedPose chosen = {best.map_T_robot, best.refined_response, best.information, 0};
  if (wide) {
    doubtful_corrections_.add_unjudged();
  } else {
    const RefinedPose predicted =
        refine(grid, points, best_prior.map_T_robot, options_.refinement, best_prior);
    if (judged_score(grid, judged, predicted) >=
        options_.prediction_share * judged_score(grid, judged, chosen))
      chosen = predicted;
    if (motion.length_m > 0) {
      if (const auto held = held_to_odometry(grid, points, judged, chosen, best_prior)) chosen = *held;
    } else {
      doubtful_corrections_.add_unjudged();  // perhaps a stalled encoder
    }
  }
  step.matched = true;
  step.response = best.response;
  step.information = chosen.information;
  step.local_T_robot = compose(older.local_T_map, chosen.map_T_robot);
}

std::optional<RefinedPose> FrontEnd::held_to_odometry(const ScoreGrid& grid, const ScanPoints& points,
                                                      const ScanPoints& judged, const RefinedPose& matched,
                                                      const PosePrior& prior) {
  constexpr double kSmallestCorrection_m = 1e-3;
  constexpr double kHeldSigma_m = 5e-3;
  const TPose2D& pose = matched.map_T_robot;
  const Eigen::Vector2d correction(pose.x - prior.map_T_robot.x, pose.y - prior.map_T_robot.y);
  if (correction.norm() < kSmallestCorrection_m) {
    doubtful_corrections_.add_supported(correction.norm());
    return {};
  }
  const Eigen::Vector2d along = correction.normalized();
  PosePrior tight = prior;
  tight.information.topLeftCorner<2, 2>() += along * along.transpose() / (kHeldSigma_m * kHeldSigma_m);
  RefinedPose held = refine(grid, points, TPose2D(prior.map_T_robot.x, prior.map_T_robot.y, pose.phi),
                            options_.refinement, tight);
  if (judged_score(grid, judged, held) < options_.held_share * judged_score(grid, judged, matched)) {
    const CorrectionScores rest =
        scores_without_best_spot(grid, judged.points.empty() ? points : judged, pose, held.map_T_robot);
    if (rest.held < options_.held_share * rest.matched) {
      doubtful_corrections_.add_supported(correction.norm());
      return {};
    }
  }
  if (doubtful_corrections_.add_doubtful(rotation_matrix(-pose.phi) * correction)) return {};
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity();
  across.topLeftCorner<2, 2>() -= along * along.transpose();
  held.information = Eigen::Matrix3d(across * held.information * across);
  return held;
}

// Propagates the pose covariance in each active map by a Kalman filter: the motion adds the noise of
// odometry, and the match reduces the covariance. Where only odometry determines the position, as along a
// corridor, the covariance grows.
void FrontEnd::propagate_covariances(const FrontEndStep& step, const Motion& motion) {
  for (PlacedLocalMap& active : active_) {
    const TPose2D before = between(active.local_T_map, last_local_T_robot_);
    const TPose2D after = between(active.local_T_map, step.local_T_robot);
    Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();
    moved(0, 2) = -(after.y - before.y);
    moved(1, 2) = after.x - before.x;
    Eigen::Matrix3d covariance = moved * active.covariance * moved.transpose();
    covariance.diagonal() += Eigen::Vector3d(motion.sigma_m * motion.sigma_m, motion.sigma_m * motion.sigma_m,
                                             motion.sigma_rad * motion.sigma_rad);
    if (step.matched) {
      // Rotation from the axes of the matched map to those of `active`.
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      turn.topLeftCorner<2, 2>() = rotation_matrix(active_.front().local_T_map.phi - active.local_T_map.phi);
      const Eigen::Matrix3d information = turn * step.information * turn.transpose();
      covariance = (Eigen::Matrix3d::Identity() + covariance * information).inverse() * covariance;
      covariance = Eigen::Matrix3d(0.5 * (covariance + covariance.transpose()));
    }
    active.covariance = covariance;
  }
}

bool FrontEnd::moved_enough(const TPose2D& local_T_robot) const {
  const TPose2D motion = between(last_node_local_T_robot_, local_T_robot);
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

void FrontEnd::end_local_maps(FrontEndStep& step, std::size_t count) {
  const auto end = active_.begin() + static_cast<std::ptrdiff_t>(count);
  for (auto active = active_.begin(); active != end; ++active) {
    active->map->finish();
    step.finished.push_back(*active);
  }
  active_.erase(active_.begin(), end);
}

void FrontEnd::draw(FrontEndStep& step, const Frame& frame) {
  if (!step.node) return;
  const std::size_t node = *step.node;
  const double moved_m = node == 0 ? 0 : length_m(between(last_node_local_T_robot_, step.local_T_robot));
  last_node_local_T_robot_ = step.local_T_robot;

  for (const PlacedLocalMap& active : active_)
    step.memberships.push_back(
        {active.id, active.anchor, between(active.local_T_map, step.local_T_robot), active.covariance});
  // A match would have set the travel to 0, so this scan is unmatched.
  const bool strays = unmatched_travel_m_ >= options_.max_unmatched_travel_m && misses_ > 1;
  const bool leaves = unmatched_travel_m_ >= options_.local_map_travel_m;
  if (strays || leaves) {
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
  const DrawingOptions drawing = {options_.scan.min_range_m, options_.local_map.max_insert_range_m,
                                  options_.local_map.smoothing_sigma_m};
  for (PlacedLocalMap& active : active_)
    active.map->insert(drawing_beams(frame, between(active.local_T_map, step.local_T_robot), drawing));
  if (share(active_.front()) >= 1.0 && active_.size() > 1) {
    end_local_maps(step, 1);
    begin_local_map(node, step.local_T_robot);
    active_.back().map->insert(drawing_beams(frame, TPose2D(0, 0, 0), drawing));
  }
  active_.front().map->scores();  // updated now, so that the match of the next scan need not wait for it
}

void FrontEnd::begin_run() {
  FrontEnd next(options_);
  next.next_local_map_ = next_local_map_;
  next.next_node_ = next_node_;
  *this = std::move(next);
}

std::vector<PlacedLocalMap> FrontEnd::finish() {
  FrontEndStep step;
  end_local_maps(step, active_.size());
  return step.finished;
}

}  // namespace psi_slam
