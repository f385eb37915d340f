// SPDX-License-Identifier: BSD-3-Clause
#include "logs/carmen/carmen_message.h"

#include <charconv>
#include <cmath>

#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMaxReadings = 100'000;  // a line that states more readings is damaged

bool is_space(char c) {
  return c == ' ' || c == '\t';
}

/// Parses `field`, which must be a single number. A number beyond the range of its type becomes infinite.
template <class Number>
bool parse(std::string_view field, Number& value) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (end != field.data() + field.size() || field.empty()) return false;
  if (error == std::errc::result_out_of_range) value = HUGE_VALF;
  return error != std::errc::invalid_argument;
}

std::vector<float> read_ranges(CarmenFields& fields) {
  const std::size_t readings = fields.count("the number of readings");
  if (readings == 0) fields.fail("the scan has 0 readings, expected 1 or more");
  return fields.ranges(readings);
}

/// Fields: type start_angle fov resolution max_range accuracy remission_mode  n r1..rn  m rem1..remm
CarmenLaserMessage read_configuration_and_ranges(CarmenFields& fields) {
  CarmenLaserMessage message;
  fields.number("the laser's type");
  message.start_angle_rad = fields.number("start_angle");
  message.field_of_view_rad = fields.number("field_of_view");
  message.resolution_rad = fields.number("angular_resolution");
  message.max_range_m = fields.number("maximum_range");
  fields.number("accuracy");
  fields.number("remission_mode");
  message.ranges_m = read_ranges(fields);
  fields.skip_numbers(fields.count("the number of remissions"), "remission");
  return message;
}

}  // namespace

CarmenFields::CarmenFields(std::string_view line, const LineReader& lines) : rest_(line), lines_(lines) {
  message_ = next_field();
}

std::string_view CarmenFields::next_field() {
  std::size_t begin = 0;
  while (begin < rest_.size() && is_space(rest_[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest_.size() && !is_space(rest_[end])) ++end;
  const std::string_view field = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return field;
}

void CarmenFields::fail(const std::string& found_and_expected) const {
  throw MalformedLine(lines_.place() + ": " + std::string(message_) + ": " + found_and_expected);
}

void CarmenFields::fail_field(std::string_view field, const std::string& expected) const {
  if (!field.empty()) fail("found \"" + quotable(field, 40) + "\", expected " + expected);
  fail(lines_.line_was_ended() ? "the line ends, expected " + expected
                               : "the file is cut off in this line, expected " + expected);
}

std::string_view CarmenFields::word(const char* what) {
  const std::string_view field = next_field();
  if (field.empty()) fail_field(field, what);
  return field;
}

double CarmenFields::number(const char* what) {
  const std::string_view field = next_field();
  double value = 0;
  if (!parse(field, value) || !std::isfinite(value)) fail_field(field, std::string(what) + ", a number");
  return value;
}

std::size_t CarmenFields::count(const char* what) {
  const std::string_view field = next_field();
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (field.empty() || error != std::errc{} || end != field.data() + field.size() || value > kMaxReadings)
    fail_field(field, std::string(what) + ", a whole number up to " + std::to_string(kMaxReadings));
  return value;
}

TimeUs CarmenFields::time(const char* what) {
  const std::string_view field = next_field();
  const auto time_us = parse_seconds(field);
  if (!time_us) fail_field(field, std::string(what) + " in seconds");
  return *time_us;
}

mrpt::math::TPose2D CarmenFields::pose(const char* what) {
  const double x = number((std::string("x of ") + what).c_str());
  const double y = number((std::string("y of ") + what).c_str());
  const double phi = number((std::string("theta of ") + what).c_str());
  mrpt::math::TPose2D pose{x, y, phi};
  if (!is_possible_odometry(pose)) fail(std::string(what) + " is beyond 10,000 km, expected metres");
  const bool is_wrapped = phi > -M_PI && phi <= M_PI;
  if (!is_wrapped) pose.normalizePhi();  // only if necessary: wrapping may change the last digit
  return pose;
}

std::vector<float> CarmenFields::ranges(std::size_t count) {
  std::vector<float> ranges_m(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view field = next_field();
    if (!parse(field, ranges_m[i]))
      fail_field(field, "reading " + std::to_string(i + 1) + " of " + std::to_string(count) + " in metres");
  }
  return ranges_m;
}

void CarmenFields::skip_numbers(std::size_t count, const char* what) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view field = next_field();
    double value = 0;
    if (!parse(field, value))
      fail_field(field, std::string(what) + " " + std::to_string(i + 1) + " of " + std::to_string(count));
  }
}

TimeUs CarmenFields::stamps() {
  const TimeUs time_us = time("ipc_timestamp");
  word("the host's name after ipc_timestamp");
  time("logger_timestamp");
  return time_us;
}

CarmenLaserMessage read_flaser(CarmenFields& fields) {
  CarmenLaserMessage message;
  message.ranges_m = read_ranges(fields);
  message.odom_T_laser = fields.pose("the pose");
  message.odom_T_robot = fields.pose("the odometry pose");
  message.time_us = fields.stamps();
  return message;
}

CarmenLaserMessage read_rawlaser(CarmenFields& fields) {
  CarmenLaserMessage message = read_configuration_and_ranges(fields);
  message.time_us = fields.stamps();
  return message;
}

CarmenLaserMessage read_robotlaser(CarmenFields& fields) {
  CarmenLaserMessage message = read_configuration_and_ranges(fields);
  message.odom_T_laser = fields.pose("the laser pose");
  message.odom_T_robot = fields.pose("the robot pose");
  for (const char* what : {"tv", "rv", "forward_safety_dist", "side_safety_dist", "turn_axis"})
    fields.number(what);
  message.time_us = fields.stamps();
  return message;
}

CarmenLaserMessage read_laser(CarmenFields& fields) {
  if (starts_with(fields.message(), "RAWLASER")) return read_rawlaser(fields);
  if (starts_with(fields.message(), "ROBOTLASER")) return read_robotlaser(fields);
  return read_flaser(fields);
}

CarmenOdometryMessage read_odometry(CarmenFields& fields) {
  CarmenOdometryMessage message;
  message.odom_T_robot = fields.pose("the odometry pose");
  for (const char* what : {"tv", "rv", "acceleration"}) fields.number(what);
  message.time_us = fields.stamps();
  return message;
}

}  // namespace psi_slam
