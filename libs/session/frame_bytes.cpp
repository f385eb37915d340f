// SPDX-License-Identifier: BSD-3-Clause
#include "session/frame_bytes.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::uint32_t kSeveralLasers = 2;  // the first version with several lasers
// Limits for damaged files: the mapper's memory grows with both.
constexpr std::uint32_t kMostLasers = 64;
constexpr double kFarthest_m = 1e7;

enum Flags : std::uint8_t {
  kHasOdometry = 1,
  kOtherSensor = 2,    ///< the sensor differs from the previous frame's and is described
  kHasCompanions = 4,  ///< the number of companions and their scans follow
};
constexpr std::uint8_t kAllFlags = kHasOdometry | kOtherSensor | kHasCompanions;

void append_pose(std::string& bytes, const TPose2D& pose) {
  append_number(bytes, pose.x);
  append_number(bytes, pose.y);
  append_number(bytes, pose.phi);
}

/// Throws MalformedBytes unless the pose can be one of a robot or a laser.
TPose2D read_pose(ByteCursor& bytes) {
  TPose2D pose;
  pose.x = bytes.number<double>();
  pose.y = bytes.number<double>();
  pose.phi = bytes.number<double>();
  if (!is_possible(pose)) throw MalformedBytes("invalid pose");
  return pose;
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

/// Bytes of what all scans of one sensor share.
std::string sensor_bytes(const LaserScan& scan) {
  std::string bytes;
  append_floats(bytes, scan.bearings_rad ? *scan.bearings_rad : std::vector<float>());
  append_number(bytes, scan.max_range_m);
  append_pose(bytes, scan.robot_T_laser);
  append_number(bytes, scan.sweep_time_s);
  append_number(bytes, static_cast<std::uint32_t>(scan.laser));
  return bytes;
}

LaserScan read_sensor(ByteCursor& bytes, std::uint32_t version) {
  LaserScan sensor;
  std::vector<float> bearings_rad = read_floats(bytes);
  if (!std::all_of(bearings_rad.begin(), bearings_rad.end(), [](float rad) { return std::isfinite(rad); }))
    throw MalformedBytes("beam bearing is not finite");
  sensor.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings_rad));
  sensor.max_range_m = bytes.number<float>();
  sensor.robot_T_laser = read_pose(bytes);
  sensor.sweep_time_s = bytes.number<float>();
  if (version >= kSeveralLasers) sensor.laser = bytes.number<std::uint32_t>();
  if (sensor.laser >= kMostLasers) throw MalformedBytes("the number of a laser is too high");
  return sensor;
}

void read_ranges(ByteCursor& bytes, LaserScan& scan) {
  scan.ranges_m = read_floats(bytes);
  if (scan.ranges_m.size() != scan.bearings_rad->size())
    throw MalformedBytes("a scan has another number of beams than its sensor");
}

/// Sensors of the last scans, by their index in a frame.
template <class Sensor>
class LastSensors {
 public:
  Sensor& at(std::size_t place) {
    if (place >= sensors_.size()) sensors_.resize(place + 1);
    return sensors_[place];
  }

 private:
  std::vector<Sensor> sensors_;
};

/// Makes `sensor` the last one. Returns whether it differs from the one before.
bool replaces(std::string& last, const std::string& sensor) {
  if (last == sensor) return false;
  last = sensor;
  return true;
}

void append_companions(std::string& bytes, const Frame& frame, LastSensors<std::string>& sensors) {
  append_number(bytes, static_cast<std::uint32_t>(frame.companions.size()));
  for (std::size_t i = 0; i < frame.companions.size(); ++i) {
    const CompanionScan& companion = frame.companions[i];
    const std::string sensor = sensor_bytes(companion.scan);
    const bool other = replaces(sensors.at(i + 1), sensor);
    append_number(bytes, static_cast<std::uint8_t>(other ? kOtherSensor : 0));
    append_number(bytes, companion.time_us);
    append_pose(bytes, companion.frame_T_robot);
    if (other) bytes += sensor;
    append_floats(bytes, companion.scan.ranges_m);
  }
}

std::vector<CompanionScan> read_companions(ByteCursor& bytes, std::uint32_t version, std::size_t first_laser,
                                           LastSensors<LaserScan>& sensors) {
  std::vector<CompanionScan> companions;
  const auto count = bytes.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    CompanionScan companion;
    const auto flags = bytes.number<std::uint8_t>();
    if ((flags & ~kOtherSensor) != 0) throw MalformedBytes("a scan has an unknown flag");
    companion.time_us = bytes.number<TimeUs>();
    companion.frame_T_robot = read_pose(bytes);
    LaserScan& sensor = sensors.at(i + 1);
    if (flags != 0) sensor = read_sensor(bytes, version);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan of a laser has no sensor description");
    companion.scan = sensor;
    if (sensor.laser <= (companions.empty() ? first_laser : companions.back().scan.laser))
      throw MalformedBytes("the lasers of a frame are out of order");
    read_ranges(bytes, companion.scan);
    companions.push_back(std::move(companion));
  }
  return companions;
}

}  // namespace

bool is_possible(const TPose2D& pose) {
  return std::abs(pose.x) <= kFarthest_m && std::abs(pose.y) <= kFarthest_m && std::isfinite(pose.phi);
}

void append_frames(std::string& bytes, const std::vector<Frame>& frames) {
  append_number(bytes, std::uint64_t{frames.size()});
  LastSensors<std::string> sensors;
  for (const Frame& frame : frames) {
    const std::string sensor = sensor_bytes(frame.scan);
    const bool other = replaces(sensors.at(0), sensor);
    const int flags = (frame.has_odometry ? kHasOdometry : 0) | (other ? kOtherSensor : 0) |
                      (frame.companions.empty() ? 0 : kHasCompanions);
    append_number(bytes, static_cast<std::uint8_t>(flags));
    append_number(bytes, frame.time_us);
    append_pose(bytes, frame.odom_T_robot);
    if (other) bytes += sensor;
    append_floats(bytes, frame.scan.ranges_m);
    if (!frame.companions.empty()) append_companions(bytes, frame, sensors);
  }
}

std::vector<Frame> read_frames(ByteCursor& bytes, std::uint32_t version) {
  const auto count = bytes.number<std::uint64_t>();
  std::vector<Frame> frames;
  LastSensors<LaserScan> sensors;
  for (std::uint64_t i = 0; i < count; ++i) {
    Frame frame;
    frame.index = frames.size();
    const auto flags = bytes.number<std::uint8_t>();
    if ((flags & ~kAllFlags) != 0) throw MalformedBytes("a scan has an unknown flag");
    frame.has_odometry = (flags & kHasOdometry) != 0;
    frame.time_us = bytes.number<TimeUs>();
    frame.odom_T_robot = read_pose(bytes);
    LaserScan& sensor = sensors.at(0);
    if ((flags & kOtherSensor) != 0) sensor = read_sensor(bytes, version);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan has no sensor description");
    frame.scan = sensor;
    read_ranges(bytes, frame.scan);
    if ((flags & kHasCompanions) != 0)
      frame.companions = read_companions(bytes, version, frame.scan.laser, sensors);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace psi_slam
