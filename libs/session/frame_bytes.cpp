// SPDX-License-Identifier: BSD-3-Clause
#include "session/frame_bytes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Protects against damaged files, because the mapper's memory grows with it.
constexpr std::uint32_t kMostLasers = 64;
// Logs have bearings within two turns. The correction of a moving robot's scans turns them by half a turn
// more.
constexpr float kMostBearing_rad = static_cast<float>(6 * M_PI);
constexpr float kMostRange_m = 10'000;  // logs have at most 1 km

enum Flags : std::uint8_t {
  kHasOdometry = 1,
  kOtherSensor = 2,    ///< the sensor differs from the previous frame's sensor and is described
  kHasCompanions = 4,  ///< the number of companions and their scans follow
  kHasImuHeading = 8,  ///< the heading by a gyroscope follows; not before version 4
};
constexpr std::uint8_t kAllFlags = kHasOdometry | kOtherSensor | kHasCompanions | kHasImuHeading;

void append_pose(std::string& bytes, const TPose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.phi}) append_number(bytes, value);
}

/// Reads a pose of a robot or a laser. Throws MalformedBytes for a pose that odometry cannot measure.
TPose2D read_pose(ByteCursor& bytes) {
  TPose2D pose;
  for (double* const value : {&pose.x, &pose.y, &pose.phi}) *value = bytes.number<double>();
  if (!is_possible_odometry(pose)) throw MalformedBytes("invalid pose");
  return pose;
}

/// Reads the time of a scan. Throws MalformedBytes for a time that no log has.
TimeUs read_time(ByteCursor& bytes) {
  const auto time_us = bytes.number<TimeUs>();
  if (!is_possible_time(time_us)) throw MalformedBytes("a scan has an impossible time stamp");
  return time_us;
}

void append_floats(std::string& bytes, const std::vector<float>& values) {
  append_number(bytes, static_cast<std::uint32_t>(values.size()));
  for (const float value : values) append_number(bytes, value);
}

std::vector<float> read_floats(ByteCursor& bytes) {
  const auto count = bytes.number<std::uint32_t>();
  ByteCursor raw(bytes.take(std::size_t{count} * sizeof(float)));
  std::vector<float> values(count);
  for (float& value : values) value = raw.number<float>();
  return values;
}

/// Returns the bytes of the description that all scans of one sensor share.
std::string sensor_bytes(const LaserScan& scan) {
  std::string bytes;
  append_floats(bytes, scan.bearings_rad ? *scan.bearings_rad : std::vector<float>());
  append_number(bytes, scan.max_range_m);
  append_pose(bytes, scan.robot_T_laser);
  append_number(bytes, scan.sweep_time_s);
  append_number(bytes, static_cast<std::uint32_t>(scan.laser));
  return bytes;
}

LaserScan read_sensor(ByteCursor& bytes) {
  LaserScan sensor;
  std::vector<float> bearings_rad = read_floats(bytes);
  if (!std::all_of(bearings_rad.begin(), bearings_rad.end(),
                   [](float rad) { return std::abs(rad) <= kMostBearing_rad; }))
    throw MalformedBytes("a beam bearing is not finite or more than three turns");
  sensor.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings_rad));
  sensor.max_range_m = bytes.number<float>();
  if (!(sensor.max_range_m >= 0 && sensor.max_range_m <= kMostRange_m))
    throw MalformedBytes("the maximum range of a laser is not between 0 and 10 km");
  sensor.robot_T_laser = read_pose(bytes);
  if (!is_possible_mount(sensor.robot_T_laser))
    throw MalformedBytes("a laser is more than 100 m from the robot's centre");
  sensor.sweep_time_s = bytes.number<float>();
  if (!std::isfinite(sensor.sweep_time_s)) throw MalformedBytes("the sweep time of a laser is not finite");
  sensor.laser = bytes.number<std::uint32_t>();
  if (sensor.laser >= kMostLasers) throw MalformedBytes("the number of a laser is too high");
  return sensor;
}

bool is_possible_range(float range_m) {
  return std::isnan(range_m) || range_m >= 0;  // the correction of a moving robot's scan can make it long
}

void read_ranges(ByteCursor& bytes, LaserScan& scan) {
  scan.ranges_m = read_floats(bytes);
  if (scan.ranges_m.size() != scan.bearings_rad->size())
    throw MalformedBytes("a scan has another number of beams than its sensor");
  if (!std::all_of(scan.ranges_m.begin(), scan.ranges_m.end(), is_possible_range))
    throw MalformedBytes("a scan has a negative range");
}

/// Appends a scan. Describes its sensor if the sensor differs from `last_sensor`.
void append_scan(std::string& bytes, int flags, TimeUs time_us, const TPose2D& pose, const LaserScan& scan,
                 std::string& last_sensor) {
  const std::string sensor = sensor_bytes(scan);
  const bool other = std::exchange(last_sensor, sensor) != sensor;
  append_number(bytes, static_cast<std::uint8_t>(flags | (other ? kOtherSensor : 0)));
  append_number(bytes, time_us);
  append_pose(bytes, pose);
  if (other) bytes += sensor;
  append_floats(bytes, scan.ranges_m);
}

}  // namespace

void FrameWriter::append(std::string& bytes, const Frame& frame) {
  append_scan(bytes,
              (frame.has_odometry ? kHasOdometry : 0) | (frame.companions.empty() ? 0 : kHasCompanions) |
                  (frame.imu_heading_rad ? kHasImuHeading : 0),
              frame.time_us, frame.odom_T_robot, frame.scan, sensors_[0]);
  if (frame.imu_heading_rad) append_number(bytes, *frame.imu_heading_rad);
  if (frame.companions.empty()) return;
  append_number(bytes, static_cast<std::uint32_t>(frame.companions.size()));
  for (std::size_t i = 0; i < frame.companions.size(); ++i) {
    const CompanionScan& companion = frame.companions[i];
    append_scan(bytes, 0, companion.time_us, companion.frame_T_robot, companion.scan, sensors_[i + 1]);
  }
}

Frame FrameReader::read(ByteCursor& bytes) {
  Frame frame;
  const auto flags = bytes.number<std::uint8_t>();
  if ((flags & ~kAllFlags) != 0) throw MalformedBytes("a scan has an unknown flag");
  frame.has_odometry = (flags & kHasOdometry) != 0;
  frame.time_us = read_time(bytes);
  frame.odom_T_robot = read_pose(bytes);
  LaserScan& sensor = sensors_[0];
  if ((flags & kOtherSensor) != 0) sensor = read_sensor(bytes);
  if (!sensor.bearings_rad) throw MalformedBytes("the first scan has no sensor description");
  frame.scan = sensor;
  read_ranges(bytes, frame.scan);
  if ((flags & kHasImuHeading) != 0) frame.imu_heading_rad = bytes.number<double>();
  if (!std::isfinite(frame.imu_heading_rad.value_or(0)))
    throw MalformedBytes("the heading by a gyroscope is not finite");
  if ((flags & kHasCompanions) != 0) frame.companions = read_companions(bytes, frame.scan.laser);
  return frame;
}

std::vector<CompanionScan> FrameReader::read_companions(ByteCursor& bytes, std::size_t first_laser) {
  std::vector<CompanionScan> companions;
  const auto count = bytes.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    CompanionScan companion;
    const auto flags = bytes.number<std::uint8_t>();
    if ((flags & ~kOtherSensor) != 0) throw MalformedBytes("a scan has an unknown flag");
    companion.time_us = read_time(bytes);
    companion.frame_T_robot = read_pose(bytes);
    if (!is_possible_mount(companion.frame_T_robot))
      throw MalformedBytes("the robot moves by more than 100 m between the scans of a frame");
    LaserScan& sensor = sensors_[i + 1];
    if (flags != 0) sensor = read_sensor(bytes);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan of a laser has no sensor description");
    companion.scan = sensor;
    if (sensor.laser <= (companions.empty() ? first_laser : companions.back().scan.laser))
      throw MalformedBytes("the lasers of a frame are out of order");
    read_ranges(bytes, companion.scan);
    companions.push_back(std::move(companion));
  }
  return companions;
}

}  // namespace psi_slam
