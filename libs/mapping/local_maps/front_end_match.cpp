// SPDX-License-Identifier: BSD-3-Clause
// How the front end matches a scan with the older active local map: the window, the prior, the searches, and
// whether a match is accepted.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "mapping/local_maps/correction_support.h"
#include "mapping/local_maps/front_end.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kResponseWeight = 0.2;  // weight of one scan in the expected response
constexpr double kLeastExpected = 0.25;  // lower bound of the expected response
constexpr double kWiderBy = 1.5;         // smallest ratio of wide to narrow half-widths for a wide search
// Limits for the search of a wide window: number of points, and the farthest distance from which the heading
// step is computed. The match is then refined with all points.
constexpr std::size_t kCoarsePoints = 120;
constexpr double kCoarseFarthest_m = 30;

constexpr double kJudgedShare = 0.2;  // smallest share of a scan in observed space that can contradict a map
// After a gap, share of the expected response that a match needs if the robot did not move as predicted.
constexpr double kSureShare = 0.6;
// Of the points in observed space, the share that must fit the map at a pose that odometry does not explain:
// after an interruption, and in a wide window.
constexpr double kLeastMatchedAgreement = 0.85;
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

}  // namespace

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
// reports a reversal as forward motion. If the narrow window has no match, an obstacle may have turned the
// robot by any angle while the wheels slipped.
SearchExtent FrontEnd::wide_extent(const Motion& motion, bool has_match) const {
  const double half_m =
      std::min(options_.max_wide_window_m,
               options_.window_m + options_.wide_window_per_motion * motion.length_m + motion.disagreement_m);
  const double half_rad =
      options_.window_rad + motion.wide_disagreement_rad +
      options_.wide_window_per_motion * (motion.turn_rad + options_.window_rad_per_metre * motion.length_m);
  const double max_rad = motion.measured ? options_.max_wide_window_rad : M_PI;
  return {half_m, half_m, has_match ? std::min(half_rad, max_rad) : M_PI};
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
/// window is hardly wider than step.window, if no response reaches the limit of wide_response_gain, or if the
/// match contradicts what the map has observed. `poor_response` is 0 if the narrow window has no match.
std::optional<MatchResult> FrontEnd::search_widely(FrontEndStep& step, const Motion& motion,
                                                   double poor_response) {
  SearchExtent wide = wide_extent(motion, poor_response > 0);
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
  if (refined.mean_score < needed ||
      contradicts(*step.points, compose(older.local_T_map, refined.map_T_robot), kLeastMatchedAgreement))
    return {};
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
  const double least_observed = std::max(1.0, kJudgedShare * static_cast<double>(scan.points.size()));
  return static_cast<double>(agreement.observed) >= least_observed && agreement.share() < least_agreement;
}

// Returns whether odometry states that the robot has left the place of the last scan that was drawn. If it
// has stalled instead, all points must show that the robot moved.
bool FrontEnd::has_left_last_node(const Motion& motion) const {
  const TPose2D left = between(last_node_local_T_robot_, compose(last_local_T_robot_, motion.predicted));
  return portable::hypot(left.x, left.y) >= options_.local_map.smoothing_sigma_m;
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
    const double predicted_score = judged_score(grid, judged, predicted);
    double score = judged_score(grid, judged, chosen);
    if (predicted_score >= options_.prediction_share * score) {
      chosen = predicted;
      score = predicted_score;
    }
    if (motion.length_m > 0) {
      if (const auto held = held_to_odometry(grid, points, judged, chosen, score, best_prior)) chosen = *held;
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
                                                      double matched_score, const PosePrior& prior) {
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
  if (judged_score(grid, judged, held) < options_.held_share * matched_score) {
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

}  // namespace psi_slam
