// SPDX-License-Identifier: BSD-3-Clause
// Aligns two scans without a map, by iterated closest points with a point-to-line metric (after Censi, "An
// ICP variant using a point-to-line metric", 2008), Gauss-Newton steps, a robust kernel and a shrinking
// search radius. The result states how reliable it is.
//
// matching/surface_alignment.h refines poses that are accurate to centimetres. This file accepts guesses that
// are off by half a metre and rates the result: cost, matched fraction of the visible points, covariance.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Points of a scan in the laser's frame, ordered by bearing, with the normal of the wall at each point.
class AlignableScan {
 public:
  struct Point {
    Eigen::Vector2d position_m;
    Eigen::Vector2d normal;  ///< unit normal of the wall in the laser's frame; zero if unknown
    double bearing_rad;      ///< as in the scan, or a full circle away
  };

  /// Uses returns up to `max_range_m`, from at most `max_points` evenly selected beams.
  explicit AlignableScan(const LaserScan& scan, double max_range_m = 30.0, std::size_t max_points = 200);

  const std::vector<Point>& points() const { return points_; }
  const mrpt::math::TPose2D& robot_T_laser() const { return robot_T_laser_; }
  /// Returns whether the first and the last beam are neighbours; see psi_slam::is_full_circle().
  bool is_full_circle() const { return is_full_circle_; }
  /// Bearing of a point in the laser's frame, within half a circle of the middle beam.
  double bearing_rad(const Eigen::Vector2d& position_m) const;

 private:
  double near_middle(double bearing_rad) const;

  std::vector<Point> points_;
  bool is_full_circle_ = false;
  double middle_bearing_rad_ = 0;  // of all beams
  mrpt::math::TPose2D robot_T_laser_;
};

/// Pose of the robot at one scan relative to its pose at another, the reference.
struct ScanAlignment {
  mrpt::math::TPose2D reference_T_scan;
  /// Mean distance to walls of the points in the reference's field of view. Distances are limited to 0.15 m,
  /// and unmatched points count as 0.15 m.
  double cost_m = 0;
  double residual_m = 0;     ///< mean distance from the matched points to walls
  double matched_share = 0;  ///< fraction of the points in the reference's field of view that match
  /// Covariance of (x, y, heading) of the laser, in the frame of the reference's laser: m^2, m rad, rad^2.
  /// Huge in directions that no wall determines.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// Standard deviation of the translation along `heading_rad`, in the frame of `covariance`, metres.
  double deviation_along_m(double heading_rad) const;
  double heading_deviation_rad() const;

  /// Returns whether matched_share exceeds 60 % and cost_m is below `max_cost_m`.
  bool is_reliable(double max_cost_m = 0.05) const { return cost_m < max_cost_m && matched_share > 0.6; }
};

/// Aligns two scans. `guess`, a guess of reference_T_scan, may be off by about 0.6 m and 10 degrees.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const mrpt::math::TPose2D& guess);

/// Aligns two scans from several guesses and returns the result with the lowest cost.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const std::vector<mrpt::math::TPose2D>& guesses);

}  // namespace psi_slam
