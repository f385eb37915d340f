// SPDX-License-Identifier: BSD-3-Clause
// Planar scans from point clouds: the points between two heights above the floor.
#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Two heights in the robot's frame, metres: z of the robot's frame is 0.
struct HeightSlice {
  double low_m = 0;
  double high_m = 0;
};

/// Parses LogOptions::slice_z_m. Returns nothing if it is empty. Throws UserError unless it consists of two
/// finite numbers, the lower one first.
std::optional<HeightSlice> height_slice(const LogOptions& options);

/// Returns the points of a cloud in the sensor's frame, whose heights are in the slice, as a scan of 720
/// beams, one in each sector of half a degree. The scan's frame is the sensor's frame projected to the floor.
/// A beam has the range and the bearing of the nearest point in its sector. A beam without a point is invalid
/// (NaN): the slice is unknown there, not free. Ignores points that are not finite, nearer than
/// `min_range_m`, or at the maximum range or beyond. The pose that the user states replaces the projected
/// pose of the sensor; `mirrored` turns the sensor upside down.
LaserScan scan_of_slice(const std::vector<mrpt::math::TPoint3Df>& points,
                        const mrpt::poses::CPose3D& robot_T_sensor, const HeightSlice& slice,
                        const LogOptions& options);

}  // namespace psi_slam
