// SPDX-License-Identifier: BSD-3-Clause
// Parses the lines of a CARMEN log.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/compression/line_reader.h"
#include "psi_slam/time_stamp.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Error for a malformed line of a CARMEN log. The text names file, line, message and what was expected.
class MalformedLine : public UserError {
 public:
  using UserError::UserError;
};

/// Parses the fields of one line from left to right. Each call throws MalformedLine if the next field is
/// missing or has another type. If the file ends within the line, the error says that the file is cut off.
class CarmenFields {
 public:
  /// Parses the name of the message, which is empty for a blank line.
  CarmenFields(std::string_view line, const LineReader& lines);

  std::string_view message() const { return message_; }

  std::string_view word(const char* what);
  double number(const char* what);
  std::size_t count(const char* what);
  TimeUs time(const char* what);
  mrpt::math::TPose2D pose(const char* what);

  /// Parses `count` ranges, metres; "nan" and "inf" are valid.
  std::vector<float> ranges(std::size_t count);
  void skip_numbers(std::size_t count, const char* what);

  /// Parses the end of every line, `ipc_timestamp host logger_timestamp`. Returns ipc_timestamp.
  TimeUs stamps();

  [[noreturn]] void fail(const std::string& found_and_expected) const;

 private:
  std::string_view next_field();
  [[noreturn]] void fail_field(std::string_view field, const std::string& expected) const;

  std::string_view rest_;
  std::string_view message_;
  const LineReader& lines_;
};

/// One message of a laser as its line states it, without any filtering. Members that this kind of message
/// lacks are zero.
struct CarmenLaserMessage {
  TimeUs time_us = 0;  ///< time of the scan: ipc_timestamp
  std::vector<float> ranges_m;
  double start_angle_rad = 0;    ///< bearing of the first reading
  double field_of_view_rad = 0;  ///< 0: not stated
  double resolution_rad = 0;     ///< step between readings; 0: not stated
  double max_range_m = 0;        ///< 0: not stated
  /// Pose of the laser; in a corrected log the result of a mapper, not odometry.
  mrpt::math::TPose2D odom_T_laser;
  mrpt::math::TPose2D odom_T_robot;
};

struct CarmenOdometryMessage {
  TimeUs time_us = 0;
  mrpt::math::TPose2D odom_T_robot;
};

// Each function parses the fields after the name of the message. It throws MalformedLine for a missing or
// invalid field.
CarmenLaserMessage read_flaser(CarmenFields& fields);    ///< reads FLASER and RLASER lines
CarmenLaserMessage read_rawlaser(CarmenFields& fields);  ///< reads RAWLASER lines, which have no poses
/// Reads ROBOTLASER lines. odom_T_robot is odometry; a mapper may have corrected odom_T_laser.
CarmenLaserMessage read_robotlaser(CarmenFields& fields);
CarmenLaserMessage read_laser(CarmenFields& fields);  ///< reads any laser line, by the name of its message
CarmenOdometryMessage read_odometry(CarmenFields& fields);

}  // namespace psi_slam
