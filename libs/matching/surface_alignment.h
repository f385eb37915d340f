// SPDX-License-Identifier: BSD-3-Clause
// Aligns a scan to the surfaces that other scans saw, by point-to-line distances (Chen and Medioni 1992;
// Censi 2008). The start pose must be accurate to a few centimetres. No grid is used, so no cell size limits
// the accuracy.
//
//     minimise over the pose:  sum_j rho(n_j . (T p_j - q_j)) / s^2  +  |x - x_held|^2 / sigma_prior^2
//
// The sum is over the points p_j of the scan, and T is the pose x as a transform. q_j and n_j are the mean
// point and the mean normal of the surface points nearest to T p_j. They are kept while no point of the scan
// may have moved farther than search_again_m, because their search takes most of the time. rho is the kernel
// of Geman and McClure. s is the standard deviation of one point, estimated from the residuals at every
// iteration. x_held is the pose of the prior. sigma_prior is prior_sigma_m for x and y, and prior_sigma_rad
// for the heading.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "base/degrees.h"
#include "matching/point_grid.h"
#include "matching/scan_points.h"

namespace psi_slam {

/// Points on straight surfaces. Each has a unit normal, which points to the side that the laser saw.
struct SurfacePoints {
  std::vector<mrpt::math::TPoint2Df> points;
  std::vector<mrpt::math::TPoint2Df> normals;
};

/// Returns the points of a scan that have a normal, in the robot's frame. Empty if the normals are unknown.
SurfacePoints surface_points(const ScanPoints& scan);

/// Surface points of several scans in one frame, with a search index.
class SurfaceMap {
 public:
  /// One scan and the robot's pose at that scan.
  struct Part {
    const SurfacePoints* points = nullptr;
    mrpt::math::TPose2D map_T_robot;
  };
  explicit SurfaceMap(const std::vector<Part>& parts);

  const PointGrid& index() const { return index_; }
  /// Normals of the points of index(), in the same order.
  const std::vector<mrpt::math::TPoint2Df>& normals() const { return normals_; }

 private:
  PointGrid index_;
  std::vector<mrpt::math::TPoint2Df> normals_;
};

struct SurfaceAlignmentOptions {
  std::size_t neighbours = 8;    ///< largest number of surface points averaged for one point of the scan
  double max_distance_m = 0.12;  ///< largest distance from a scan point to its surface points
  double max_turn_rad = radians_from_degrees(30.0L);  ///< largest angle between both normals, below pi/2
  double kernel_m = 0.03;       ///< residual at which a point has a quarter of its weight
  double prior_sigma_m = 0.01;  ///< standard deviation of `held_at`, which fixes the pose along a corridor
  double prior_sigma_rad = radians_from_degrees(0.25L);
  int iterations = 4;
  /// The surface points near the scan are searched again if one of its points may have moved farther than
  /// this.
  double search_again_m = 0.002;
  std::size_t min_points = 20;  ///< with fewer points near surfaces, the result is the start
};

struct SurfaceAlignment {
  mrpt::math::TPose2D map_T_robot;
  std::size_t points = 0;  ///< number of the scan's points near surfaces, at the last iteration
};

/// Finds the pose near `start` at which the scan's points lie on the surfaces, with a prior at `held_at`.
/// Returns `start` if too few points are near surfaces, see SurfaceAlignmentOptions::min_points.
SurfaceAlignment align_to_surfaces(const SurfaceMap& map, const SurfacePoints& scan,
                                   const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& held_at,
                                   const SurfaceAlignmentOptions& options);

}  // namespace psi_slam
