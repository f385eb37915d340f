// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carmen/carmen_message.h"
#include "psi_slam/frame.h"
#include "frames/laser_choice.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// The message names that can hold the scans the user asked for (`LogOptions::laser`), the preferred first.
/// Throws UserError for a laser that CARMEN does not have.
std::vector<std::string> carmen_laser_messages(const std::string& laser,
                                               const std::string& option = "log.laser");

/// The same for each laser of a choice (log.laser); of all, the front one, the rear one and the others, so
/// that a laser which the log tells of in several kinds of messages is read once.
std::vector<std::vector<std::string>> carmen_lasers_wanted(const LaserChoice& choice);

/// Turns the messages of one CARMEN laser into scans: what the message states, over that what PARAM lines
/// state, over that what the user states.
class CarmenLaser {
 public:
  CarmenLaser(std::string message_name, const LogOptions& options);

  const std::string& message_name() const { return message_name_; }
  const std::string& position() const { return position_; }  ///< "front", "rear", or empty

  /// Whether anybody has said where the laser is on the robot.
  bool knows_mount() const;

  /// Takes a PARAM line's name and value (the fields behind "PARAM"); other parameters pass unread. A
  /// malformed line changes nothing.
  void take_parameter(CarmenFields& fields);

  /// The mount where neither the user nor a PARAM line states one.
  void set_mount_by_poses(const mrpt::math::TPose2D& robot_T_laser) { mount_by_poses_ = robot_T_laser; }

  /// Throws MalformedLine when the bearings cannot be known; `fields` gives the place.
  LaserScan scan(CarmenLaserMessage message, const CarmenFields& fields);

 private:
  bool has_mount_parameters() const;
  mrpt::math::TPose2D robot_T_laser() const;
  double max_range_m(const CarmenLaserMessage& message) const;
  std::vector<float> bearings_rad(const CarmenLaserMessage& message, const CarmenFields& fields) const;

  struct Geometry {
    std::size_t beams = 0;
    double start_angle_rad = 0;
    double field_of_view_rad = 0;
    double resolution_rad = 0;
    bool operator==(const Geometry& other) const;
  };

  std::string message_name_;
  std::string position_;  // "front" or "rear"
  LogOptions options_;
  std::optional<double> offset_m_;
  std::optional<double> side_offset_m_;
  std::optional<double> angular_offset_rad_;
  std::optional<mrpt::math::TPose2D> mount_by_poses_;
  std::optional<double> stated_max_range_m_;
  std::optional<double> stated_resolution_rad_;
  Geometry geometry_;  // that of bearings_
  BeamBearings bearings_;
};

}  // namespace psi_slam
