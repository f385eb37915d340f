// SPDX-License-Identifier: BSD-3-Clause
// Converts laser scans to points for matching and beams for drawing.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "mapping/local_maps/local_map.h"
#include "matching/scan_points.h"
#include "psi_slam/frame.h"

namespace psi_slam {

struct ScanFilterOptions {
  /// Largest range of returns that are matched. The default exceeds the range of usual 2D lidars. It only
  /// bounds memory and time if a reading is damaged.
  double max_range_m = 200.0;
  double spacing_m = 0.03;  ///< smallest distance between successive points
};

/// Returns the points of a scan in the robot's frame, thinned so that near surfaces do not outweigh far ones.
ScanPoints matching_points(const LaserScan& scan, const ScanFilterOptions& options);

/// Returns the points of all scans of a frame, in the robot's frame at the frame's time. Each scan is thinned
/// separately.
ScanPoints matching_points(const Frame& frame, const ScanFilterOptions& options);

struct DrawingOptions {
  double max_range_m = 200.0;  ///< longer beams are cut at this range
  /// Surfaces between beams are drawn where the beams are at least this far apart, see ends_on_one_surface().
  /// Use the standard deviation of range noise: LocalMapOptions::smoothing_sigma_m.
  double min_surface_spacing_m = 0.03;
};

/// Converts the returns of a scan to beams in the frame of a local map, metres.
Beams drawing_beams(const LaserScan& scan, const mrpt::math::TPose2D& map_T_robot,
                    const DrawingOptions& options);

/// Returns the beams of each scan of a frame, in the order of for_each_scan().
std::vector<Beams> drawing_beams(const Frame& frame, const mrpt::math::TPose2D& map_T_robot,
                                 const DrawingOptions& options);

}  // namespace psi_slam
