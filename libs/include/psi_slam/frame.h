// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A log of any format is read as a stream of frames. A frame is one laser scan with the odometry pose at the
/// scan's time. If the robot has several lasers, the frame also holds the scans that the other lasers took at
/// nearly the same time.
///
/// Poses are in SE(2): x forward, y left, yaw counter-clockwise in (-pi, pi]. `a_T_b` is the pose of b in a.
/// MRPT's TPose2D composes poses with `a_T_b + b_T_c`; `a_T_c - a_T_b` is b_T_c.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Bearings of the beams in the laser's frame, radians, counter-clockwise positive, one for each range and in
/// the same order. Successive scans of one laser usually share one vector.
using BeamBearings = std::shared_ptr<const std::vector<float>>;

/// One planar range scan. `ranges_m[i]`, metres, was measured along `(*bearings_rad)[i]`. A finite value is a
/// return. +infinity means no return: the reading was at or beyond the maximum range. NaN means an invalid
/// reading: zero, negative, below the minimum range or flagged as invalid.
struct LaserScan {
  std::vector<float> ranges_m;  ///< one range for each beam, metres; infinity: no return; NaN: invalid
  BeamBearings bearings_rad;    ///< one bearing for each beam, radians
  float max_range_m = 0;  ///< maximum range of the sensor, metres; readings at or beyond it are no returns
  mrpt::math::TPose2D robot_T_laser;  ///< pose of the laser on the robot
  /// Time from the first beam to the last, seconds. Negative: the last beam is measured first. The time stamp
  /// of the scan is the time of the beam that is measured first. 0: all beams are simultaneous, or the time
  /// is unknown.
  float sweep_time_s = 0;
  std::size_t laser = 0;  ///< number of the laser among the lasers that are read, from 0
};

/// Scan of another laser of the robot, taken at nearly the time of a frame.
struct CompanionScan {
  LaserScan scan;                     ///< the scan
  TimeUs time_us = 0;                 ///< time of this scan, microseconds
  mrpt::math::TPose2D frame_T_robot;  ///< robot pose at `time_us`, relative to its pose at the frame's time
};

/// One scan with the robot's odometry at the scan's time.
struct Frame {
  std::size_t index = 0;             ///< number of the frame among the frames read, from 0
  TimeUs time_us = 0;                ///< time of the scan, microseconds
  mrpt::math::TPose2D odom_T_robot;  ///< pose of the robot by odometry, at `time_us`
  LaserScan scan;                    ///< scan of the laser with the smallest number in this frame
  bool has_odometry = true;          ///< false: the motion is unknown and odom_T_robot is meaningless
  /// Heading of the robot by a gyroscope, radians, relative to an unknown start and not wrapped; empty: none.
  std::optional<double> imu_heading_rad{};
  std::vector<CompanionScan> companions{};  ///< scans of other lasers, sorted by LaserScan::laser
  /// Set by the mapper: the scan matched nothing, and contradicts the map at the pose by odometry. Drawings
  /// leave it out.
  bool is_misplaced = false;
};

/// Returns the robot's pose at the time of a companion scan. The parameter `map_T_robot` is the robot's pose
/// at the frame's time.
mrpt::math::TPose2D companion_pose(const CompanionScan& companion, const mrpt::math::TPose2D& map_T_robot);

/// Calls `take(scan, map_T_robot)` for each scan of a frame, with the robot's pose at the time of that scan.
/// The parameter `map_T_robot` is the robot's pose at the frame's time. The beams of a scan start at the
/// position of map_T_robot + scan.robot_T_laser.
template <class Take>
void for_each_scan(const Frame& frame, const mrpt::math::TPose2D& map_T_robot, Take take) {
  take(frame.scan, map_T_robot);
  for (const CompanionScan& companion : frame.companions)
    take(companion.scan, companion_pose(companion, map_T_robot));
}

}  // namespace psi_slam
