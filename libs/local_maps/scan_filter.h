// SPDX-License-Identifier: BSD-3-Clause
// From a laser scan to the points that are matched and the beams that are drawn.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "local_maps/local_map.h"
#include "psi_slam/frame.h"
#include "matching/scan_points.h"

namespace psi_slam {

struct ScanFilterOptions {
  double min_range_m = 0.1;
  double max_range_m = 40.0;  ///< returns beyond are not matched
  double spacing_m = 0.03;    ///< neighbouring points nearer than this to the last one kept are dropped
};

/// The scan's returns in the robot's frame, thinned so that near surfaces do not outweigh far ones.
ScanPoints matching_points(const LaserScan& scan, const ScanFilterOptions& options);

/// The same for all scans of a frame, each thinned by itself, from where the robot was at the frame's time.
ScanPoints matching_points(const Frame& frame, const ScanFilterOptions& options);

/// All returns as beams, seen from the robot's pose in a local map; those beyond `max_range_m` are cut there.
Beams drawing_beams(const LaserScan& scan, const mrpt::math::TPose2D& map_T_robot, double min_range_m,
                    double max_range_m);

/// The same for all scans of a frame.
std::vector<Beams> drawing_beams(const Frame& frame, const mrpt::math::TPose2D& map_T_robot,
                                 double min_range_m, double max_range_m);

}  // namespace psi_slam
