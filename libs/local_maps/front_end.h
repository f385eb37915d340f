// SPDX-License-Identifier: BSD-3-Clause
// The front end: predicts the pose of each scan by odometry, or by constant velocity without odometry,
// matches the scan with the active local map (equations 1 and 2), and inserts it if the robot moved enough.
//
// It works in a continuous frame, "local", which loop closing never moves. The mapper knows the pose of that
// frame in the global map. Two local maps are active at a time and overlap by half: scans are matched with
// the older one and inserted into both.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "local_maps/constant_velocity_model.h"
#include "local_maps/local_map.h"
#include "local_maps/scan_filter.h"
#include "matching/make_matcher.h"
#include "psi_slam/frame.h"

namespace psi_slam {

struct FrontEndOptions {
  ScanFilterOptions scan;
  LocalMapOptions local_map;
  RefinementOptions refinement;

  // Search window: half-widths for a robot at rest, and their growth with the odometry's motion. The
  // difference between odometry and constant velocity (the motion of the last step) is added.
  double window_m = 0.15;
  double window_rad = radians_from_degrees(7.0L);
  double window_per_metre = 0.3;
  double window_per_radian = 0.6;
  double window_rad_per_metre = radians_from_degrees(8.5L);
  double max_window_m = 1.0;
  double max_window_rad = radians_from_degrees(35.0L);

  // The response that a match can reach depends on the place: on the overlap with the local map, on how much
  // of it are smooth walls, on the spacing of the beams. So matches are judged by the response expected here:
  // a decaying mean of those of the last scans, where a scan without a match counts as 0, and at least 0.25.
  double min_response_share = 0.3;  ///< below this share, the prediction is kept instead of the match
  /// A match below this share is poor: odometry may be wrong by more than the window holds. The scan is
  /// searched again in a wide window, whose match must exceed this share.
  double poor_response_share = 0.75;
  double wide_response_gain = 1.6;  ///< factor by which the match in the wide window must exceed the poor one
  double wide_window_per_motion = 2.0;  ///< growth of the wide window with the motion by odometry
  double max_wide_window_m = 2.5;
  double max_wide_window_rad = radians_from_degrees(60.0L);

  // Standard deviations of the prediction, which holds the pose where the scan does not (along corridors):
  // for a robot at rest, and their growth with the motion and with its difference from constant velocity.
  double prior_sigma_m = 0.02;
  double prior_sigma_rad = radians_from_degrees(6.0L);
  double prior_per_metre = 0.1;
  double prior_per_radian = 0.5;
  double prior_per_surprise = 0.5;
  /// The pose refined directly from the prediction is preferred if it scores at least this share of the
  /// searched one, because noise decides the search along a corridor.
  double prediction_share = 0.95;

  // Only a small part of the scan supports a doubtful correction of the odometry. A person who walks ahead
  // along a bare corridor causes such corrections, which would hold the robot back. A correction is doubtful
  // if the pose held to odometry scores at least `held_share` of the match, with or without the spot of the
  // scan, no larger than a person, that supports the match most. Doubtful corrections are summed, and the sum
  // decays over `doubtful_correction_travel_m` of travel. A correction that would raise the sum above
  // `max_doubtful_correction_m` is not applied. So the scale of odometry may be wrong by
  // max_doubtful_correction_m / doubtful_correction_travel_m.
  double held_share = 0.9;
  double max_doubtful_correction_m = 0.2;
  double doubtful_correction_travel_m = 3.0;

  // Noise of odometry, for the covariance of the poses. It matters where scans do not determine the pose. Its
  // variance grows with time, path and turns, whatever the rate of scans.
  double odometry_sigma_m = 0.005;          ///< after one second at rest
  double odometry_sigma_per_metre = 0.055;  ///< after one metre
  double odometry_sigma_per_radian = 0.02;  ///< after a turn of one radian
  double odometry_sigma_rad = radians_from_degrees(0.2L);
  double odometry_sigma_rad_per_metre = radians_from_degrees(1.3L);
  double odometry_sigma_rad_per_radian = radians_from_degrees(2.0L);

  double node_distance_m = 0.15;  ///< a scan becomes a node if the robot moved this far since the last node
  double node_rotation_rad = radians_from_degrees(6.0L);  ///< or if it turned by this angle since then
  /// A local map ends after this number of nodes, or this path of the robot. The next begins at half of it.
  std::size_t nodes_per_local_map = 80;
  double local_map_travel_m = 15.0;
  /// All local maps end if at least two successive scans were not matched and the robot has travelled this
  /// far since. Odometry's error over such a stretch would distort the maps.
  double max_unmatched_travel_m = 0.5;
};

/// Result of one scan.
struct FrontEndStep {
  mrpt::math::TPose2D local_T_robot;
  bool matched = false;  ///< false: there was no local map, or the response was too low
  double response = 0;
  SearchExtent window;
  std::int64_t evaluations = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the match, along the axes of the local map
  std::shared_ptr<const ScanPoints> points;

  std::optional<std::size_t> node;  ///< number of the node, from 0, if the scan became one
  /// A local map with this node, and the node's pose in it. `memberships` excludes maps that begin with this
  /// node. It includes maps that end here because of unmatched scans, which links the graph, though they do
  /// not hold this scan.
  struct Membership {
    std::size_t local_map;
    std::size_t anchor;
    mrpt::math::TPose2D anchor_T_node;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of anchor_T_node, along the anchor's axes
  };
  std::vector<Membership> memberships;   ///< older first
  std::vector<PlacedLocalMap> finished;  ///< local maps that ended with this node, older first
};

class FrontEnd {
 public:
  explicit FrontEnd(const FrontEndOptions& options);

  /// Predicts, matches and inserts one scan.
  FrontEndStep add(const Frame& frame);

  /// Ends the local maps that are still active and returns them, older first.
  std::vector<PlacedLocalMap> finish();

  /// Begins another run, whose start is unrelated to the last pose: resets the frame "local" to the robot of
  /// the next scan. Numbers of nodes and local maps continue. Call finish() before.
  void begin_run();

  /// Local maps that scans are inserted into, older first, at most two.
  const std::vector<PlacedLocalMap>& active() const { return active_; }

 private:
  /// Motion since the last scan by odometry, and its difference from constant velocity, the motion of the
  /// last step. The difference reveals slipping wheels, stalling encoders and late time stamps. Confidence in
  /// the constant-velocity prediction decays with time.
  struct Motion {
    mrpt::math::TPose2D odometry;
    bool measured = true;  ///< false: there is no odometry
    double length_m = 0;
    double turn_rad = 0;
    double surprise_m = 0;
    double surprise_rad = 0;
    double sigma_m = 0;  ///< noise, for the covariance of the poses
    double sigma_rad = 0;
  };
  Motion motion_to(const Frame& frame) const;
  /// Motion by the constant-velocity model, for scans without odometry.
  Motion constant_velocity_motion(TimeUs time_us) const;
  SearchExtent search_extent(const Motion& motion) const;
  PosePrior prior(const mrpt::math::TPose2D& map_T_robot, const Motion& motion) const;
  SearchExtent wide_extent(const Motion& motion) const;
  void match(FrontEndStep& step, const Motion& motion);
  MatchResult search(FrontEndStep& step, const ScoreGrid& grid, const PosePrior& prior,
                     const SearchExtent& window, double min_response) const;
  std::optional<MatchResult> search_widely(FrontEndStep& step, const Motion& motion, double poor_response);
  /// Updates the sum of doubtful corrections. If the sum would be too large (see FrontEndOptions), returns
  /// the pose held to the prediction in the direction of the correction, with no information in that
  /// direction. Otherwise empty: the match is kept.
  std::optional<RefinedPose> held_to_odometry(const ScoreGrid& grid, const ScanPoints& scan,
                                              const RefinedPose& matched, const PosePrior& prior);
  void propagate_covariances(const FrontEndStep& step, const Motion& motion);
  void end_local_maps(FrontEndStep& step, std::size_t count);
  bool moved_enough(const mrpt::math::TPose2D& local_T_robot) const;
  void insert(FrontEndStep& step, const Frame& frame);
  void begin_local_map(std::size_t node, const mrpt::math::TPose2D& local_T_robot);

  FrontEndOptions options_;
  CorrelativeMatcher matcher_;
  std::vector<PlacedLocalMap> active_;  ///< older first, at most two
  std::size_t next_local_map_ = 0;
  std::size_t next_node_ = 0;
  std::optional<Frame> last_;  ///< without its ranges
  ConstantVelocityModel constant_velocity_;
  mrpt::math::TPose2D last_local_T_robot_;
  mrpt::math::TPose2D last_motion_;
  Eigen::Vector2d doubtful_correction_m_ = Eigen::Vector2d::Zero();  ///< decaying sum, in the robot's axes
  double expected_response_ = 0.5;                                   ///< decaying mean of the last responses
  int misses_ = 0;                                                   ///< successive scans without a match
  double unmatched_travel_m_ = 0;  ///< path since the last match, or since the newest local map began
  mrpt::math::TPose2D last_node_local_T_robot_;
};

}  // namespace psi_slam
