// SPDX-License-Identifier: BSD-3-Clause
// The front end (method, step 2): predicts each scan's pose by odometry, or by
// the robot's speed where there is none, matches it with the active local map
// (equations 1 and 2), and inserts it when the robot moved enough.
//
// It works in a frame of its own, "local", which is continuous: no loop closing ever moves it. The mapper
// knows where that frame lies in the global map. Two local maps are active at a time and overlap by half:
// scans are matched with the older, inserted into both.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "local_maps/local_map.h"
#include "local_maps/placed_local_map.h"
#include "local_maps/scan_filter.h"
#include "local_maps/constant_velocity_model.h"
#include "psi_slam/frame.h"
#include "matching/make_matcher.h"

namespace psi_slam {

struct FrontEndOptions {
  ScanFilterOptions scan;
  LocalMapOptions local_map;
  RefinementOptions refinement;

  // The search window: half-widths of a robot that stands still, and how they grow with the motion that
  // odometry reports. What odometry and a steady robot (the last step's motion again) disagree about is
  // added.
  double window_m = 0.15;
  double window_rad = radians_from_degrees(7.0L);
  double window_per_metre = 0.3;
  double window_per_radian = 0.6;
  double window_rad_per_metre = radians_from_degrees(8.5L);
  double max_window_m = 1.0;
  double max_window_rad = radians_from_degrees(35.0L);
  double min_response = 0.25;  ///< a match below this is not believed: the prediction stands

  // The standard deviations of the prediction, which hold the pose where the scan does not (along corridors):
  // of a robot that stands still, and how they grow with the motion and with the disagreement above.
  double prior_sigma_m = 0.02;
  double prior_sigma_rad = radians_from_degrees(6.0L);
  double prior_per_metre = 0.1;
  double prior_per_radian = 0.5;
  double prior_per_surprise = 0.5;
  /// Refined straight from the prediction, a pose that scores at least this share of the searched one is
  /// preferred: along a corridor the search's best is decided by noise.
  double prediction_share = 0.95;

  // A match that contradicts odometry in position for long needs to be supported by enough of the scan, else
  // a person who walks ahead along a bare corridor holds the robot back. A pull away from odometry is
  // supported when the pose held to odometry scores less than `held_share` of the match, and still does
  // without the one spot of the scan, no larger than a person, that speaks most for the match. Pulls that are
  // not add up to the strain, which is forgotten over `doubtful_correction_travel_m` of travel; those that would raise it
  // beyond `max_doubtful_correction_m` are not followed. Odometry's scale may so be off by max_doubtful_correction_m / doubtful_correction_travel_m.
  double held_share = 0.9;
  double max_doubtful_correction_m = 0.2;
  double doubtful_correction_travel_m = 3.0;

  // Odometry's noise a step, for the covariance of the poses: where scans determine the pose it hardly
  // matters.
  double odometry_sigma_m = 0.01;
  double odometry_sigma_rad = radians_from_degrees(0.3L);
  double odometry_sigma_per_metre = 0.05;
  double odometry_sigma_per_radian = 0.05;

  double node_distance_m = 0.15;  ///< a scan becomes a node when the robot moved this far
  double node_rotation_rad = radians_from_degrees(6.0L);  ///< or turned this much since the last node
  std::size_t nodes_per_local_map =
      80;                            ///< a local map ends after these many, the next begins at half of them,
  double local_map_travel_m = 15.0;  ///< or when the robot has travelled this far in it
  /// All local maps end when at least two scans in a row were not matched and the robot has travelled this
  /// far meanwhile: what is drawn after such a stretch is out of place by odometry's error, and would bend
  /// them.
  double max_unmatched_travel_m = 0.5;
};

/// What became of one scan.
struct FrontEndStep {
  mrpt::math::TPose2D local_T_robot;
  bool matched = false;  ///< false: nothing to match with, or the match was not believed
  double response = 0;
  SearchExtent window;
  std::int64_t evaluations = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the match, in the local map's axes
  std::shared_ptr<const ScanPoints> points;

  std::optional<std::size_t> node;  ///< set when the scan became a node: nodes count from 0
  /// The local maps it was inserted into, older first, with its pose in each; a map that begins with this
  /// very node is not among them. A node without a match that ends the local maps is a member of them all the
  /// same, so that the graph holds together, but its scan is not in them.
  struct Membership {
    std::size_t local_map;
    std::size_t anchor;
    mrpt::math::TPose2D anchor_T_node;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of anchor_T_node, along the anchor's axes
  };
  std::vector<Membership> memberships;
  std::vector<PlacedLocalMap> finished;  ///< the local maps that this node completed, older first
};

class FrontEnd {
 public:
  explicit FrontEnd(const FrontEndOptions& options);

  /// The per-scan step.
  FrontEndStep add(const Frame& frame);

  /// Ends the local maps that are still active and returns them, older first.
  std::vector<PlacedLocalMap> finish();

  /// The next scan is of another drive: nothing before says where it was taken. The frame "local" begins anew
  /// at its robot; nodes and local maps are numbered on. Needs finish().
  void begin_run();

  /// The local maps that scans are inserted into, older first, at most two.
  const std::vector<PlacedLocalMap>& active() const { return active_; }

 private:
  /// The motion since the last scan as odometry reports it, and how far it is from that of a steady robot,
  /// the last step's again: a wheel that slips, an encoder that stalls or catches up, a stamp that is late
  /// all show there. The steady robot is believed the less, the more time has passed.
  struct Motion {
    mrpt::math::TPose2D odometry;
    bool measured = true;  ///< false: there is no odometry
    double length_m = 0;
    double turn_rad = 0;
    double surprise_m = 0;
    double surprise_rad = 0;
    double sigma_m = 0;  ///< its noise, for the covariance of the poses
    double sigma_rad = 0;
  };
  Motion motion_to(const Frame& frame) const;
  /// Without odometry: the motion of a steady robot, as uncertain as its speed.
  Motion steady_motion(TimeUs time_us) const;
  SearchExtent search_extent(const Motion& motion) const;
  PosePrior prior(const mrpt::math::TPose2D& map_T_robot, const Motion& motion) const;
  void match(FrontEndStep& step, const Motion& motion);
  /// The pose held to the prediction in the direction of the match's pull, when too few points support that
  /// pull and it adds up to too much (see FrontEndOptions::max_doubtful_correction_m); none: the match stands. Its
  /// information has nothing in that direction. Adds up doubtful_correction_m_.
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
  Eigen::Vector2d doubtful_correction_m_ = Eigen::Vector2d::Zero();  ///< in the robot's axes
  int misses_ = 0;                                      ///< scans in a row that were not matched
  double unmatched_travel_m_ = 0;  ///< since the last match, or since the newest local map began
  mrpt::math::TPose2D last_node_local_T_robot_;
};

}  // namespace psi_slam
