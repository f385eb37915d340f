// SPDX-License-Identifier: BSD-3-Clause
// Aligns two scans without a map and rates the result. Uses the point-to-line alignment of
// matching/surface_alignment.h with a shrinking search radius, so that a guess may be off by half a metre.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "matching/surface_alignment.h"
#include "psi_slam/frame.h"

namespace psi_slam {

/// Points of a scan on straight surfaces, prepared for alignment. All are in the robot's frame.
class AlignableScan {
 public:
  /// Uses returns up to `max_range_m`, from at most `max_points` evenly selected beams.
  explicit AlignableScan(const LaserScan& scan, double max_range_m = 30.0, std::size_t max_points = 200);

  const SurfacePoints& surface() const { return surface_; }
  const SurfaceMap& map() const { return map_; }

  /// Returns whether a point is in the field of view, between the first and the last return.
  bool sees(const Eigen::Vector2d& point_m) const;

 private:
  SurfacePoints surface_;
  SurfaceMap map_;
  mrpt::math::TPose2D robot_T_laser_;
  double first_rad_ = 0;  // bearings of the first and the last return, in the laser's frame
  double last_rad_ = 0;
};

/// Pose of the robot at one scan relative to its pose at another, the reference.
struct ScanAlignment {
  mrpt::math::TPose2D reference_T_scan;
  /// Mean distance from the visible points to surfaces. Each distance is limited to 0.15 m, which also counts
  /// for unmatched points.
  double cost_m = 0;
  double matched_share = 0;  ///< fraction of the visible points with a surface within 0.15 m, in [0, 1]
  /// Covariance of (x, y, heading), m and rad. Huge in directions that no surface determines.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// Standard deviation of the translation in the direction of `heading_rad`, metres.
  double deviation_along_m(double heading_rad) const;
  double heading_deviation_rad() const;
};

/// Aligns from a guess that is off by at most about 0.6 m and 10 degrees.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const mrpt::math::TPose2D& guess);

/// Aligns from several guesses and returns the result with the lowest cost.
ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const std::vector<mrpt::math::TPose2D>& guesses);

}  // namespace psi_slam
