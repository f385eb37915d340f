// SPDX-License-Identifier: BSD-3-Clause
// Aligns a scan to the surfaces that other scans saw, by point-to-line distances (Chen and Medioni 1992;
// Censi 2008), for poses that are already accurate to a few centimetres. It uses no grid, so that cells do
// not limit its accuracy.
//
//     minimise over the pose:  sum_j rho(n_j . (T p_j - q_j)) / s^2  +  |x - x_held|^2 / sigma_prior^2
//
// over the points p_j of the scan. q_j and n_j are the mean point and the mean normal of the surface points
// nearest to p_j, rho is the kernel of Geman and McClure, and s is the noise of one point, estimated from the
// residuals.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "base/degrees.h"
#include "matching/point_index.h"
#include "matching/scan_points.h"

namespace psi_slam {

/// Points on straight surfaces, each with the unit normal of its surface on the side that the laser saw.
struct SurfacePoints {
  std::vector<mrpt::math::TPoint2Df> points;
  std::vector<mrpt::math::TPoint2Df> normals;
};

/// Returns the points of a scan that have a normal, in the robot's frame.
SurfacePoints surface_points(const ScanPoints& scan);

/// Searchable surface points of several scans in one frame.
class SurfaceMap {
 public:
  struct Part {
    const SurfacePoints* points = nullptr;
    mrpt::math::TPose2D map_T_robot;
  };
  explicit SurfaceMap(const std::vector<Part>& parts);

  const PointIndex& index() const { return index_; }
  /// Normals of the points of index(), in the same order.
  const std::vector<mrpt::math::TPoint2Df>& normals() const { return normals_; }

 private:
  PointIndex index_;
  std::vector<mrpt::math::TPoint2Df> normals_;
};

struct SurfaceAlignmentOptions {
  std::size_t neighbours = 8;    ///< surface points averaged for the comparison with one point of the scan
  double max_distance_m = 0.12;  ///< largest distance between points of one surface
  double max_turn_rad = radians_from_degrees(30.0L);  ///< largest angle between their normals; below pi/2
  double kernel_m = 0.03;       ///< residual at which a point has a quarter of its weight
  double prior_sigma_m = 0.01;  ///< of the start; holds the pose along a corridor
  double prior_sigma_rad = radians_from_degrees(0.25L);
  int iterations = 4;
  std::size_t min_points = 20;  ///< points near surfaces; with fewer, the result is the start
};

struct SurfaceAlignment {
  mrpt::math::TPose2D map_T_robot;
  std::size_t points = 0;  ///< points of the scan near surfaces at the last iteration
};

/// Finds the pose near `start` at which the scan's points lie on the surfaces, with a prior at `held_at`.
SurfaceAlignment align_to_surfaces(const SurfaceMap& map, const SurfacePoints& scan,
                                   const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& held_at,
                                   const SurfaceAlignmentOptions& options);

}  // namespace psi_slam
