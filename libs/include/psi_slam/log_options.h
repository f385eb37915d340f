// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>

#include "frames/beam_angles.h"

namespace psi_slam {

/// What the user may state about a log, whatever its format. Everything left out is taken from the log
/// itself, or, where the log does not say, from the convention of its format as told at each member.
struct LogOptions {
  /// Pose of the laser on the robot. Default: the log's own (CARMEN: PARAM robot_frontlaser_offset and kin,
  /// or the difference of the poses of raw ROBOTLASER lines; rawlog: the sensor's pose; ROS: the transforms);
  /// CARMEN logs that do not say have the front laser in the robot's centre, and the rear one there looking
  /// backwards.
  std::optional<mrpt::math::TPose2D> robot_T_laser;

  /// How the beams share the field of view. Default: what the log states, else `usual_beam_angles`.
  BeamAngles beam_angles = BeamAngles::kAuto;

  /// Field of view of the laser, radians, in (0, 2 pi]. Default: what the log states, else
  /// `usual_field_of_view_rad`.
  std::optional<double> field_of_view_rad;

  /// Readings at or beyond this, metres, are no returns. Default: what the log states, else
  /// `kUnstatedMaxRange_m`.
  std::optional<double> max_range_m;

  /// Readings below this, metres, are no returns (a robot that sees its own bumper).
  double min_range_m = 0;

  /// The readings run clockwise: a laser mounted upside down whose log does not say so.
  bool mirrored = false;

  /// Which laser. CARMEN: "front", "rear" or a message name such as "RAWLASER2"; rawlog: a sensor label; ROS:
  /// a topic of scans. Default: the front laser if there is one, else the only one; of a rawlog, the first.
  /// "all", or several with commas between them, are read together (see LaserChoice).
  std::string laser;

  /// How lasers are mounted that the log does not tell of, or tells wrongly: "NAME X Y YAW" with metres and
  /// degrees, "mirrored" behind it for one that hangs upside down; several with commas between them. Names as
  /// in `laser`. `robot_T_laser`, which is for one laser alone, stands over it.
  std::string laser_mounts;

  /// The time from the first beam of a scan to its last, seconds, in [0, 1]: the robot's motion in it is
  /// taken out of the scan. Default: what the log states (ROS: time_increment), else 0, which leaves scans
  /// alone.
  std::optional<double> sweep_time_s;

  // ROS bags only. What is left empty is found by the types of the topics and by the transforms.

  /// The topic of the scans (sensor_msgs/LaserScan), or several as in `laser`, over which it stands.
  std::string scan_topic;

  /// The topic of the odometry (nav_msgs/Odometry); one of transforms ("/tf") takes the transform instead.
  std::string odometry_topic;

  /// The frame that odometry is told in. Default: the nearest above the laser whose name has "odom" in it.
  std::string odom_frame;

  /// The robot's frame, which odometry moves. Default: the child frame of the odometry's messages, or that
  /// of the transform from odom_frame.
  std::string base_frame;

  /// 2 takes every second scan, and so on; odometry stays that of each scan's own time.
  std::size_t every_nth_scan = 1;
};

/// The maximum range, metres, of CARMEN logs that state none. Indoor lasers of such logs report 50 m or more
/// for "no return", with codes that differ from log to log (50.00, 51.06, 81.83, 81.91).
inline constexpr double kUnstatedMaxRange_m = 50.0;

/// Throws UserError naming the first value that makes no sense.
void check_log_options(const LogOptions& options);

}  // namespace psi_slam
