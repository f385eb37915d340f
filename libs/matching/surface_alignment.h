// SPDX-License-Identifier: BSD-3-Clause
// A scan laid on the surfaces that other scans saw, points on lines (Chen and Medioni 1992; Censi 2008), for
// poses that are right to a few centimetres already. No grid stands in between: what a grid's cells round off
// is what this can still win.
//
//     minimise over the pose:  sum_j rho(n_j . (T p_j - q_j)) / s^2  +  |x - x_held|^2 / sigma_prior^2
//
// over the points p_j of the scan; q_j and n_j are the mean point and the mean normal of the surface points
// nearest to it, rho is the kernel of Geman and McClure, and s the noise of one point, taken from the
// residuals themselves.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "base/degrees.h"
#include "matching/point_index.h"
#include "matching/scan_points.h"

namespace psi_slam {

/// Points that lie on straight surfaces, each with the surface's unit normal on the side it was seen from.
struct SurfacePoints {
  std::vector<mrpt::math::TPoint2Df> points;
  std::vector<mrpt::math::TPoint2Df> normals;
};

/// Those of a scan's points that have a normal, in the robot's frame.
SurfacePoints surface_points(const ScanPoints& scan);

/// The surface points of several scans in one frame, ready to be searched.
class SurfaceMap {
 public:
  struct Part {
    const SurfacePoints* points = nullptr;
    mrpt::math::TPose2D map_T_robot;
  };
  explicit SurfaceMap(const std::vector<Part>& parts);

  const PointIndex& index() const { return index_; }
  /// Of the index's points, by number.
  const std::vector<mrpt::math::TPoint2Df>& normals() const { return normals_; }

 private:
  PointIndex index_;
  std::vector<mrpt::math::TPoint2Df> normals_;
};

struct SurfaceAlignmentOptions {
  std::size_t neighbours = 8;    ///< surface points whose mean each point of the scan is compared with
  double max_distance_m = 0.12;  ///< points farther apart are of two surfaces,
  double max_turn_rad = radians_from_degrees(30.0L);  ///< and those whose normals differ by more; below pi/2
  double kernel_m = 0.03;       ///< residual at which a point has lost three quarters of its weight
  double prior_sigma_m = 0.01;  ///< how far the start may be off: along a corridor nothing else holds
  double prior_sigma_rad = radians_from_degrees(0.25L);
  int iterations = 4;
  std::size_t min_points = 20;  ///< of the scan near surfaces; with fewer the pose stays where it was
};

struct SurfaceAlignment {
  mrpt::math::TPose2D map_T_robot;
  std::size_t points = 0;  ///< of the scan that were near surfaces at the last iteration
};

/// The pose near `start` at which the scan's points lie on the surfaces; held by a prior at `held_at`.
SurfaceAlignment align_to_surfaces(const SurfaceMap& map, const SurfacePoints& scan,
                                   const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& held_at,
                                   const SurfaceAlignmentOptions& options);

}  // namespace psi_slam
