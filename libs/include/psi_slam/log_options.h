// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Options for reading logs.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>

namespace psi_slam {

/// How n beams divide a field of view F. Bearings run counter-clockwise from the right.
enum class BeamAngles {
  kAuto,                  ///< as the log states, otherwise as usual for the number of beams
  kCentredStepInclusive,  ///< -F/2 ... +F/2 in steps F/(n-1): a beam at each end
  kCentredHalfStep,       ///< -F/2 + s/2 ... +F/2 - s/2 in steps s = F/n (180 beams: -89.5 ... +89.5 degrees)
  kLeftOpen,              ///< -F/2 ... +F/2 - s in steps s = F/n (180 beams: -90 ... +89 degrees)
  kSkipZero,              ///< as kLeftOpen without the beam at 0 (180 beams: -90 ... -1, +1 ... +90 degrees)
};

/// Order in time in which a laser measures the beams of a scan, compared with their order in the log.
enum class SweepDirection {
  kAuto,      ///< as the scans of the log determine it in turns, otherwise as the log states
  kForward,   ///< the first beam is measured first
  kBackward,  ///< the last beam is measured first: drivers of RPLIDAR lasers reverse the beams
};

/// Options for reading a log of any format. A member without a value takes the value that the log states. If
/// the log states none, the default described at the member applies.
struct LogOptions {
  /// Pose of the laser on the robot, metres and radians; only for a single laser. Default: as the log states.
  /// CARMEN: PARAM lines such as robot_frontlaser_offset, else the difference between the laser pose and the
  /// robot pose in ROBOTLASER lines. Rawlog: the pose of the sensor. ROS: the transforms. If a CARMEN log
  /// states none, both lasers are at the robot's centre, and the rear laser looks backwards.
  std::optional<mrpt::math::TPose2D> robot_T_laser;

  /// How the beams divide the field of view. Default: as the log states, otherwise the usual convention for
  /// the number of beams.
  BeamAngles beam_angles = BeamAngles::kAuto;

  /// Field of view of the laser, radians, in (0, 2 pi]. Default: as the log states, otherwise the usual one
  /// for the number of beams.
  std::optional<double> field_of_view_rad;

  /// Maximum range, metres: readings at or beyond it are no returns. Default: the smallest code that the
  /// laser writes for "no return", if the readings show one; otherwise as the log states, otherwise
  /// `kUnstatedMaxRange_m`.
  std::optional<double> max_range_m;

  /// Minimum range, metres: readings below it are invalid. The default is below the minimum range of usual
  /// lasers, which write small values for surfaces that are too near and for errors. Raise it if the laser
  /// sees the robot's own bumper.
  double min_range_m = 0.1;

  /// True: the readings run clockwise, because the laser is mounted upside down and the log does not say so.
  bool mirrored = false;

  /// Which laser to read. CARMEN: "front", "rear" or a message name such as "RAWLASER2". Rawlog: a sensor
  /// label. ROS: a topic of scans. "all", or several names separated by commas: each frame combines scans of
  /// these lasers. Default: all lasers whose mounts are stated and differ; else CARMEN: the front laser if
  /// there is one; rawlog and ROS: the first laser.
  std::string laser;

  /// Poses of lasers that the log states wrongly or not at all: "NAME X Y YAW" in metres and degrees. Append
  /// "mirrored" if the laser is mounted upside down. Separate several lasers by commas. Names are those of
  /// `laser`. `robot_T_laser` overrides this option.
  std::string laser_mounts;

  /// Time from the first beam of a scan to its last, seconds, in [0, 1]. The robot's motion during this time
  /// is removed from the scan. Default: as the log states (ROS: time_increment), otherwise 0, which leaves
  /// scans unchanged.
  std::optional<double> sweep_time_s;

  /// Order in time of the beams of a scan. Applies to scans with a sweep time.
  SweepDirection sweep_direction = SweepDirection::kAuto;

  /// Replaces returns of the robot's own body by invalid readings: returns whose bearing and range stay the
  /// same while the robot moves. True: wherever the log shows them.
  bool mask_own_body = true;

  /// Odometry to use. "auto": the odometry of the log; without any, scans have none (see
  /// Frame::has_odometry). "none": no odometry, even if the log has some. ROS bags: a topic
  /// (nav_msgs/Odometry), or a topic of transforms ("/tf"), which selects the transform from odom_frame to
  /// base_frame. An empty text means "auto".
  std::string odometry = "auto";

  /// True distance divided by the distance that odometry measures, > 0: distances of odometry are multiplied
  /// by it. Default: 1, or with `calibrate` the estimate.
  std::optional<double> odometry_scale;

  /// Time by which the time stamps of scans are later than the measurement, compared with the stamps of
  /// odometry, seconds, in [-600, 600]. "0.1": the delay of all lasers. "NAME SECONDS": the delay of one
  /// laser; separate several lasers by commas. Names are those of `laser`; lasers that are not named have no
  /// delay. "auto": 0, or with `calibrate` the estimate for each laser.
  std::string scan_delay_s = "auto";

  /// Estimates odometry_scale, scan_delay_s and the pose of the laser on the robot from the scans before
  /// mapping, and uses the values that the log determines well and that no other option states.
  bool calibrate = false;

  /// Gyroscope that predicts the heading of scans without odometry. "auto": the only one of the log. "none":
  /// no gyroscope. Otherwise a topic (sensor_msgs/Imu) or a sensor label of a rawlog (CObservationIMU).
  std::string imu = "auto";

  /// ROS bags and rawlogs: heights above the floor between which the points of a sensor_msgs/PointCloud2, or
  /// of a 3D observation, form a scan: "LOW HIGH" in metres. An empty text reads no point clouds.
  std::string slice_z_m;

  // The next three options apply to ROS bags only. If empty, the reader finds topics by their types and
  // frames by the transforms.

  /// Topic of the scans (sensor_msgs/LaserScan), several topics separated by commas, or "all". Overrides
  /// `laser`.
  std::string scan_topic;

  /// Frame of the odometry poses. Default: the nearest ancestor of the laser's frame whose name contains
  /// "odom".
  std::string odom_frame;

  /// Frame of the robot, whose pose odometry measures. Default: the child frame of the odometry messages, or
  /// of the transform from odom_frame. Without odometry: the topmost frame above the laser whose name
  /// contains "base", otherwise the laser's own frame.
  std::string base_frame;

  /// Reads every nth scan; 1 reads all. Each scan keeps the odometry of its own time.
  std::size_t every_nth_scan = 1;
};

/// Maximum range, metres, for logs that state none and show no code for "no return".
inline constexpr double kUnstatedMaxRange_m = 50.0;

/// Checks the options. Throws UserError that names the first option with an invalid value.
void check_log_options(const LogOptions& options);

}  // namespace psi_slam
