// SPDX-License-Identifier: BSD-3-Clause
// What every log, whatever its format, is read into: a stream of frames (method: one laser scan with the
// odometry pose at its own time stamp and the pose of the laser on the robot; of a robot with several lasers
// also what the others saw at nearly that time).
//
// Poses are SE(2), x forward, y left, yaw counter-clockwise in (-pi, pi]; `a_T_b` is the pose of b in a.
// MRPT's TPose2D composes with `a_T_b + b_T_c` and inverts with `a_T_c - a_T_b` (c seen from b).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// The bearing of each beam in the laser's own frame, radians, counter-clockwise positive, in the order of
/// the ranges. Shared by all scans of one sensor.
using BeamBearings = std::shared_ptr<const std::vector<float>>;

/// One planar range scan. `ranges_m[i]` was measured along `(*bearings_rad)[i]`; a range that is not a return
/// (at or beyond the sensor's maximum, zero, negative, not finite, flagged invalid) is NaN.
struct LaserScan {
  std::vector<float> ranges_m;
  BeamBearings bearings_rad;
  float max_range_m = 0;  ///< of the sensor: what it reports beyond this is "no return"
  mrpt::math::TPose2D robot_T_laser;
  float sweep_time_s =
      0;  ///< from the first beam, at the scan's time, to the last; 0: all at once, or not said
  std::size_t laser = 0;  ///< which of the robot's lasers that are read, the first being 0
};

/// What another laser of the same robot saw at nearly the time of a frame.
struct CompanionScan {
  LaserScan scan;
  TimeUs time_us = 0;                 ///< its own
  mrpt::math::TPose2D frame_T_robot;  ///< the robot at that time, seen from where it was at the frame's
};

/// One scan with the robot's odometry at the scan's own time.
struct Frame {
  std::size_t index = 0;  ///< in the order of the log, from 0
  TimeUs time_us = 0;
  mrpt::math::TPose2D odom_T_robot;
  LaserScan scan;
  bool has_odometry = true;  ///< false: nothing is known of the motion, and odom_T_robot says nothing
  std::vector<CompanionScan> companions{};  ///< in the order of their lasers; each comes behind `scan.laser`
};

/// Calls `take(scan, map_T_robot)` for each scan of a frame with the robot's pose when the scan was taken,
/// given that at the frame's time. Every scan has an origin of its own: map_T_robot + scan.robot_T_laser.
template <class Take>
void for_each_scan(const Frame& frame, const mrpt::math::TPose2D& map_T_robot, Take take) {
  take(frame.scan, map_T_robot);
  for (const CompanionScan& companion : frame.companions)
    take(companion.scan, map_T_robot + companion.frame_T_robot);
}

}  // namespace psi_slam
