// SPDX-License-Identifier: BSD-3-Clause
// Aligns two scans by themselves, to judge a log before anything maps it: iterated closest points, point to
// line (Censi, "An ICP variant using a point-to-line metric", 2008, in spirit; here by Gauss-Newton with a
// robust kernel and a shrinking search radius). It is small and careful rather than general: it knows when it
// does not know.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// The points of a scan in the laser's frame, in the order of their bearings, with the direction of the wall
/// at each.
class AlignableScan {
 public:
  struct Point {
    Eigen::Vector2d position_m;
    Eigen::Vector2d normal;  ///< unit length, or zero where no wall is seen
    double bearing_rad;
  };

  /// Takes returns up to `max_range_m`; at most about `max_points`, evenly thinned.
  explicit AlignableScan(const LaserScan& scan, double max_range_m = 30.0, std::size_t max_points = 200);

  const std::vector<Point>& points() const { return points_; }
  const mrpt::math::TPose2D& robot_T_laser() const { return robot_T_laser_; }

 private:
  std::vector<Point> points_;
  mrpt::math::TPose2D robot_T_laser_;
};

struct AlignmentOptions {
  double first_search_radius_m = 0.6;
  double last_search_radius_m = 0.15;
  int iterations = 25;
};

/// How the robot of one scan stands in the frame of the robot of another.
struct ScanAlignment {
  mrpt::math::TPose2D reference_T_scan;
  double cost_m =
      0;  ///< mean distance of points to walls, cut off at, and counted as, the last search radius
  double residual_m = 0;     ///< mean distance of the matched points alone
  double matched_share = 0;  ///< of the points that the reference could have seen, in [0, 1]
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  ///< of (x, y, heading), m and rad; huge where a wall is missing

  /// Standard deviation, metres, of the translation in the direction of `heading_rad`.
  double deviation_along_m(double heading_rad) const;
  double heading_deviation_rad() const;
};

/// From a guess not further off than about the first search radius and 10 degrees.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const mrpt::math::TPose2D& guess, const AlignmentOptions& options = {});

/// The cheapest of the alignments from several guesses.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const std::vector<mrpt::math::TPose2D>& guesses,
                          const AlignmentOptions& options = {});

}  // namespace psi_slam
