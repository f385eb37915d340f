// SPDX-License-Identifier: BSD-3-Clause
// Steps that the readers of all formats share when they turn a message of a laser into a LaserScan.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Pose of a laser on the robot, projected to the floor.
struct FloorMount {
  mrpt::math::TPose2D robot_T_laser;
  bool upside_down = false;  ///< seen from above, the laser counts its beams in the opposite direction
};

/// Throws UserError that starts with `place` if the laser is tilted by more than 15 degrees.
FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place);

/// Reverses the sign of all bearings.
void mirror(std::vector<float>& bearings_rad);

/// Replaces each range, metres, that is no return with NaN: not finite, zero or negative, below
/// `min_range_m`, at or beyond `max_range_m`.
void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m);

/// Sets the maximum range of a scan and marks its readings without a return. The user's options override the
/// maximum that the log states; `stated_max_range_m` is 0 if it states none. The larger minimum applies.
void limit_ranges(LaserScan& scan, const LogOptions& options, double stated_max_range_m,
                  double stated_min_range_m = 0);

}  // namespace psi_slam
