// SPDX-License-Identifier: BSD-3-Clause
// The front end predicts the pose of each scan and matches the scan with the active local map (equations 1
// and 2). It inserts the scan if the robot moved enough. Odometry gives the prediction; without odometry, the
// constant-velocity model does, with the turn by a gyroscope if there is one.
//
// The front end works in a continuous frame, "local", which loop closing never moves. The mapper knows the
// pose of this frame in the map. At most two local maps are active at a time, and successive local maps
// overlap by half. Scans are matched with the older active map and inserted into both.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "base/task_thread.h"
#include "mapping/local_maps/constant_velocity_model.h"
#include "mapping/local_maps/doubtful_corrections.h"
#include "mapping/local_maps/local_map.h"
#include "mapping/local_maps/scan_filter.h"
#include "mapping/local_maps/standstill.h"
#include "mapping/local_maps/tracked_points.h"
#include "matching/make_matcher.h"
#include "psi_slam/frame.h"

namespace psi_slam {

struct FrontEndOptions {
  ScanFilterOptions scan;
  LocalMapOptions local_map;
  RefinementOptions refinement;

  // Half-widths of the search window for a robot at rest, and their growth with the predicted motion. The
  // disagreement of odometry with the last motion is added, see Motion. Each successive scan without a match
  // widens the window, up to the maximum.
  double window_m = 0.15;
  double window_rad = radians_from_degrees(7.0L);
  double window_per_metre = 0.3;
  double window_per_radian = 0.6;
  double window_rad_per_metre = radians_from_degrees(8.5L);
  double max_window_m = 1.0;
  double max_window_rad = radians_from_degrees(35.0L);

  // The response that a match can reach depends on the overlap with the local map, the share of smooth walls
  // and the spacing of beams. So each response is compared with an expected response: a decaying mean over
  // the last scans. A scan without a match counts as 0. The expected response is at least 0.25.
  double min_response_share = 0.3;  ///< share of the expected response that a match needs
  /// A match below this share of the expected response is poor: the error of odometry may exceed the window.
  /// The front end then searches a wide window.
  double poor_response_share = 0.75;
  /// A match in the wide window must reach this multiple of the poor response, and this multiple of the
  /// response that a match needs.
  double wide_response_gain = 1.6;
  double wide_window_per_motion = 2.0;  ///< growth of the wide half-widths per metre or radian of motion
  double max_wide_window_m = 2.5;
  double max_wide_window_rad = radians_from_degrees(60.0L);  ///< with a poor match; without, all headings
  /// Prediction for scans without odometry. Their wide window may span all headings.
  ConstantVelocityOptions constant_velocity;

  // Standard deviations of the predicted pose for a robot at rest, and their growth with the motion and with
  // Motion::disagreement_m and disagreement_rad. The prediction determines the pose where the scan does not,
  // as along a corridor.
  double prior_sigma_m = 0.02;
  double prior_sigma_rad = radians_from_degrees(6.0L);
  double prior_per_metre = 0.1;
  double prior_per_radian = 0.5;
  double prior_per_surprise = 0.5;
  /// Matches points_along_walls() while odometry states that the robot moves. Keeps the length of maps of
  /// bare corridors.
  bool along_walls = true;
  /// The pose refined directly from the prediction replaces the searched pose if its score is at least this
  /// share of the searched pose's score. Along a corridor, noise decides where the search finds its best
  /// pose.
  double prediction_share = 0.95;

  // Only a small part of the scan supports a doubtful correction of the odometry. A person who walks ahead of
  // the robot along a bare corridor causes such corrections: the mapped path becomes too short. A correction
  // is doubtful if the pose predicted by odometry scores at least `held_share` of the score of the matched
  // pose. It is also doubtful if this is so without the person-sized spot of the scan that supports the match
  // most. DoubtfulCorrections decides which doubtful corrections are applied. If odometry is as accurate as
  // stated and scans are close together, the applied ones correct a scale error of odometry of at most
  // max_sum_m / travel_m.
  double held_share = 0.9;
  DoubtfulCorrectionOptions doubtful_corrections;

  // Standard deviations of odometry, for the covariance of the poses where scans do not determine the pose.
  // The variance grows with time, path and turns, and does not depend on the rate of scans.
  double odometry_sigma_m = 0.005;          ///< standard deviation after one second at rest
  double odometry_sigma_per_metre = 0.055;  ///< standard deviation after one metre
  double odometry_sigma_per_radian = 0.02;  ///< standard deviation after a turn of one radian
  double odometry_sigma_rad = radians_from_degrees(0.2L);
  double odometry_sigma_rad_per_metre = radians_from_degrees(1.3L);
  double odometry_sigma_rad_per_radian = radians_from_degrees(2.0L);

  // A scan becomes a node if the robot moved this far or turned by this angle since the last node.
  double node_distance_m = 0.15;
  double node_rotation_rad = radians_from_degrees(6.0L);
  /// A local map ends after this number of nodes or after this path length. The next local map begins when
  /// the current one has reached half of either limit.
  std::size_t nodes_per_local_map = 80;
  double local_map_travel_m = 15.0;
  /// All active local maps end if at least two successive scans were not matched and the robot has travelled
  /// this far since the last match. The error of odometry over this path would distort the maps. They end at
  /// the first scan without a match if it is farther than local_map_travel_m.
  double max_unmatched_travel_m = 0.5;
};

/// Result of the front end for one scan.
struct FrontEndStep {
  mrpt::math::TPose2D local_T_robot;
  /// The scan contradicts every explanation of an interruption: that odometry continued, that the robot stood
  /// still, and that it continued as before. The scan was not inserted.
  bool lost = false;
  bool matched = false;  ///< false: no local map, no points, or a response that is too low
  /// The scan is unmatched and contradicts what the older active map has observed. It becomes no node,
  /// because it would spoil the map and later scans would match it.
  bool misplaced = false;
  bool stands = false;  ///< the robot has stood still for long, and the pose is its place
  /// The robot stands, and the scan is not needed to represent the standstill. The front end's later steps
  /// are the same without its ranges if the next Standstill::kRecentScans scans stand, too.
  bool repeats = false;
  double response = 0;
  SearchExtent window;
  std::int64_t evaluations = 0;
  /// Information matrix of the matched (x, y, theta), along the axes of the older active map; 0 if unmatched.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  std::shared_ptr<const ScanPoints> points;
  /// The frame without the motion during its sweeps. Empty if no motion was removed.
  std::optional<Frame> straightened;

  std::optional<std::size_t> node;  ///< number of the scan's node, from 0; empty if it became no node
  /// Pose of this node in one local map. `memberships` excludes maps that begin with this node. It includes
  /// maps that end at this node because of unmatched scans. Such a map does not hold this scan, but links the
  /// node to the graph.
  struct Membership {
    std::size_t local_map;
    std::size_t anchor;
    mrpt::math::TPose2D anchor_T_node;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of anchor_T_node, anchor's axes
  };
  /// Covariance of this node's pose relative to the node before, along the axes of that node.
  Eigen::Matrix3d covariance_since_node = Eigen::Matrix3d::Zero();
  std::vector<Membership> memberships;   ///< poses of the node in its local maps, older first
  std::vector<PlacedLocalMap> finished;  ///< local maps that ended at this node, older first
};

class FrontEnd {
 public:
  /// With `draws_beside`, the younger local map is drawn in a thread of its own while later scans are
  /// matched, which needs only the older one. Has no effect on the results.
  explicit FrontEnd(const FrontEndOptions& options, bool draws_beside = false);

  /// Tracks the robot to one scan and draws the scan: track() and draw().
  FrontEndStep add(const Frame& frame);

  /// Predicts and matches one scan. If the robot has stood still for long, only checks that the scan
  /// fits; a frame whose ranges were discarded fits. If `may_be_lost` is true, an interruption that nothing
  /// explains sets FrontEndStep::lost. Then call finish() and begin_run(), and track the scan again.
  /// Otherwise call draw() before the next scan.
  FrontEndStep track(const Frame& frame, bool may_be_lost = false);

  /// Draws the scan of a new node into the active local maps, and sets the memberships and finished maps of
  /// the step. Does nothing if the scan became no node. `frame` is FrontEndStep::straightened if that is not
  /// empty. The pose does not need this, so it can be given before.
  void draw(FrontEndStep& step, const Frame& frame);

  /// Ends the local maps that are still active and returns them, older first.
  std::vector<PlacedLocalMap> finish();

  /// Begins another run, whose start is unrelated to the last pose. The pose of the next scan becomes the
  /// origin of the frame "local". The numbering of nodes and local maps continues. Call finish() first.
  void begin_run();

  /// Local maps that scans are inserted into, older first, at most two. Waits for the drawing of the younger
  /// one.
  const std::vector<PlacedLocalMap>& active() const;
  /// Whether there is an active local map. Unlike active(), does not wait for drawing.
  bool has_active() const { return !active_.empty(); }

 private:
  /// Predicted motion since the last scan.
  struct Motion {
    mrpt::math::TPose2D predicted;  ///< motion by odometry or constant velocity, in the last pose's frame
    bool measured = true;           ///< false: there is no odometry
    double length_m = 0;
    double turn_rad = 0;
    /// Difference between the motion by odometry and the motion of the last step, reduced as the time between
    /// scans grows. A large difference reveals slipping wheels, stalling encoders or late time stamps.
    /// Without odometry, the values of sigma_m and sigma_rad.
    double disagreement_m = 0;
    double disagreement_rad = 0;
    /// The value of disagreement_rad for the wide window. With a gyroscope, it is larger: the window finds
    /// the robot although the gyroscope is wrong.
    double wide_disagreement_rad = 0;
    double sigma_m = 0;  ///< standard deviations of the motion, for the covariance of the poses
    double sigma_rad = 0;
    bool after_gap = false;  ///< scans are missing before this scan
    /// Standard deviation of the motion for DoubtfulCorrections; empty without odometry. Includes the change
    /// of odometry's speed since the last step, because odometry that is read late or in bursts moves
    /// unevenly.
    std::optional<double> correction_sigma_m = {};
    /// Odometry began again at zero or jumped farther than a robot drives, so the motion is not measured.
    bool was_restarted = false;
  };
  /// Returns the step of a robot that has stood still for long, or nothing if the robot may have moved.
  std::optional<FrontEndStep> step_of_standing_robot(const Frame& frame);
  bool fits_standstill(const ScanPoints& scan);
  /// Removes the motion during the sweep, as the constant-velocity model predicts it, from the scans of a
  /// frame without odometry. Sets step.straightened. Returns the motion of the first laser's sweep.
  mrpt::math::TPose2D straighten_by_prediction(const Frame& frame, FrontEndStep& step) const;
  /// Removes the motion from the middle of the last sweep to `local_T_middle`, the pose in the middle of this
  /// sweep, from the scans of `frame` instead. Sets the pose, the points and the straightened frame of
  /// `step`.
  void straighten_by_match(const Frame& frame, const mrpt::math::TPose2D& local_T_middle,
                           FrontEndStep& step) const;
  Motion motion_to(const Frame& frame) const;
  /// Returns whether the matches show that the robot moves while odometry stays exactly the same: it moved
  /// farther than the window of a robot at rest. Odometry then measures no motion.
  bool has_frozen_odometry(const Frame& frame) const;
  /// Predicts the motion by the constant-velocity model and the gyroscope, for scans without odometry.
  Motion constant_velocity_motion(const Frame& frame) const;
  SearchExtent search_extent(const Motion& motion) const;
  PosePrior prior(const mrpt::math::TPose2D& map_T_robot, const Motion& motion) const;
  SearchExtent wide_extent(const Motion& motion, bool has_match) const;
  void match(FrontEndStep& step, const Motion& motion);
  std::vector<mrpt::math::TPose2D> hypotheses(const Motion& motion) const;
  bool has_left_last_node(const Motion& motion) const;
  /// Smallest share of a scan's points in observed space that fits a pose that was only predicted.
  static constexpr double kLeastAgreement = 0.5;
  bool contradicts(const ScanPoints& scan, const mrpt::math::TPose2D& local_T_robot,
                   double least_agreement) const;
  /// `expected_response` is the value before the match of this scan.
  bool is_lost(const FrontEndStep& step, const Motion& motion, TimeUs time_us,
               double expected_response) const;
  MatchResult search(FrontEndStep& step, const ScanPoints& scan, const ScoreGrid& grid,
                     const PosePrior& prior, const SearchExtent& window, double min_response) const;
  std::optional<MatchResult> search_widely(FrontEndStep& step, const Motion& motion, double poor_response);
  /// Decides whether to apply the correction of odometry by a match. Returns nothing if it is applied.
  /// Otherwise returns the pose held to the prediction in the direction of the correction. The information of
  /// this pose is zero in that direction. `matched_score` is the score of the match for the judged points.
  std::optional<RefinedPose> held_to_odometry(const ScoreGrid& grid, const ScanPoints& points,
                                              const ScanPoints& judged, const RefinedPose& matched,
                                              double matched_score, const PosePrior& prior);
  void propagate_covariances(const FrontEndStep& step, const Motion& motion);
  void end_local_maps(FrontEndStep& step, std::size_t count);
  bool moved_enough(const mrpt::math::TPose2D& local_T_robot) const;
  bool becomes_node(const FrontEndStep& step) const;
  /// Returns whether all active local maps end because of unmatched scans, see
  /// FrontEndOptions::max_unmatched_travel_m.
  bool has_left_local_maps() const;
  void begin_local_map(std::size_t node, const mrpt::math::TPose2D& local_T_robot);

  FrontEndOptions options_;
  /// Draws the younger local map. Owned by pointer, so that begin_run() can keep it.
  std::unique_ptr<TaskThread> younger_drawing_;
  CorrelativeMatcher matcher_;
  std::vector<PlacedLocalMap> active_;  ///< active local maps, older first, at most two
  std::size_t next_local_map_ = 0;
  std::size_t next_node_ = 0;
  std::optional<Frame> last_;  ///< last frame, without its scans
  ConstantVelocityModel constant_velocity_;
  Standstill standstill_;
  mrpt::math::TPose2D last_local_T_robot_;
  mrpt::math::TPose2D unchanged_odometry_local_T_robot_;  ///< pose of the first scan with the last odometry
  mrpt::math::TPose2D last_local_T_middle_;               ///< pose in the middle of the last sweep
  mrpt::math::TPose2D last_motion_;
  mrpt::math::TPose2D last_predicted_motion_;  ///< motion of the last step as predicted, before the match
  DoubtfulCorrections doubtful_corrections_;
  double expected_response_ = 0.5;  ///< decaying mean of the responses
  int misses_ = 0;                  ///< number of successive scans without a match
  double unmatched_travel_m_ = 0;   ///< path since the last match, or since all local maps ended
  mrpt::math::TPose2D last_node_local_T_robot_;
  Eigen::Matrix3d covariance_since_node_ = Eigen::Matrix3d::Zero();  ///< along the axes of the last node
};

}  // namespace psi_slam
