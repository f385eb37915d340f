// SPDX-License-Identifier: BSD-3-Clause
// The front end (method, step 2): predicts each scan's pose by odometry, matches it with the active local map
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

#include "psi_slam/local_maps/local_map.h"
#include "psi_slam/local_maps/scan_filter.h"
#include "psi_slam/logs/frame.h"
#include "psi_slam/matching/correlative_matcher.h"

namespace psi_slam {

struct FrontEndOptions {
  ScanFilterOptions scan;
  LocalMapOptions local_map;
  RefinementOptions refinement;

  double window_m = 0.15;  ///< half-width of the search window for a robot that stands still,
  double window_rad = 0.12;
  double window_per_metre = 0.3;   ///< and how much it grows with the motion that odometry reports
  double window_per_radian = 0.6;  ///< (metres per metre, radians per radian)
  double window_rad_per_metre = 0.15;
  double max_window_m = 1.0;
  double max_window_rad = 0.6;
  double min_response = 0.25;  ///< a match below this is not believed: the prediction stands

  double prior_sigma_m = 0.10;  ///< of the prediction, for the refinement: holds the pose along corridors
  double prior_sigma_rad = 0.10;

  double node_distance_m = 0.2;     ///< a scan becomes a node when the robot moved this far,
  double node_rotation_rad = 0.15;  ///< turned this much since the last node
  std::size_t nodes_per_local_map =
      60;                            ///< a local map ends after these many, the next begins at half of them
  double local_map_travel_m = 15.0;  ///< or when the robot has travelled this far in it
};

/// A local map in the mapper's hands: from its first scan on, shared between front end and loop closing.
struct ActiveLocalMap {
  std::size_t id = 0;
  std::size_t anchor = 0;           ///< the node it began with
  mrpt::math::TPose2D local_T_map;  ///< the anchor's pose in the front end's frame
  std::size_t first_node = 0;
  std::size_t last_node = 0;
  double travelled_m = 0;
  std::shared_ptr<LocalMap> map;
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
  /// very node is not among them.
  struct Membership {
    std::size_t local_map;
    std::size_t anchor;
    mrpt::math::TPose2D anchor_T_node;
  };
  std::vector<Membership> memberships;
  std::optional<ActiveLocalMap> finished;  ///< a local map that this node completed
};

class FrontEnd {
 public:
  explicit FrontEnd(const FrontEndOptions& options);

  /// The per-scan step.
  FrontEndStep add(const Frame& frame);

  /// Ends the local maps that are still active and returns them, older first.
  std::vector<ActiveLocalMap> finish();

 private:
  mrpt::math::TPose2D predict(const Frame& frame) const;
  SearchExtent window_after(const mrpt::math::TPose2D& motion) const;
  void match(FrontEndStep& step, const mrpt::math::TPose2D& predicted) const;
  bool moved_enough(const mrpt::math::TPose2D& local_T_robot) const;
  void insert(FrontEndStep& step, const Frame& frame);
  void begin_local_map(std::size_t node, const mrpt::math::TPose2D& local_T_robot);

  FrontEndOptions options_;
  CorrelativeMatcher matcher_;
  std::vector<ActiveLocalMap> active_;  ///< older first, at most two
  std::size_t next_local_map_ = 0;
  std::size_t next_node_ = 0;
  std::optional<Frame> last_;  ///< without its ranges
  mrpt::math::TPose2D last_local_T_robot_;
  mrpt::math::TPose2D last_node_local_T_robot_;
};

}  // namespace psi_slam
