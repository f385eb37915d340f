// SPDX-License-Identifier: BSD-3-Clause
#include "frame_bytes.h"

#include <memory>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

enum Flags : std::uint8_t {
  kHasOdometry = 1,
  kOtherSensor = 2,  ///< than the frame before: it is described behind the pose
};
constexpr std::uint8_t kAllFlags = kHasOdometry | kOtherSensor;

void append_pose(std::string& bytes, const TPose2D& pose) {
  append_number(bytes, pose.x);
  append_number(bytes, pose.y);
  append_number(bytes, pose.phi);
}

TPose2D read_pose(ByteCursor& bytes) {
  TPose2D pose;
  pose.x = bytes.number<double>();
  pose.y = bytes.number<double>();
  pose.phi = bytes.number<double>();
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

/// What the scans of one sensor share.
std::string sensor_bytes(const LaserScan& scan) {
  std::string bytes;
  append_floats(bytes, scan.bearings_rad ? *scan.bearings_rad : std::vector<float>());
  append_number(bytes, scan.max_range_m);
  append_pose(bytes, scan.robot_T_laser);
  append_number(bytes, scan.sweep_time_s);
  return bytes;
}

void read_sensor(ByteCursor& bytes, LaserScan& sensor) {
  sensor.bearings_rad = std::make_shared<const std::vector<float>>(read_floats(bytes));
  sensor.max_range_m = bytes.number<float>();
  sensor.robot_T_laser = read_pose(bytes);
  sensor.sweep_time_s = bytes.number<float>();
}

}  // namespace

void append_frames(std::string& bytes, const std::vector<Frame>& frames) {
  append_number(bytes, std::uint64_t{frames.size()});
  std::string sensor;
  for (const Frame& frame : frames) {
    std::string own = sensor_bytes(frame.scan);
    const bool other = own != sensor || &frame == &frames.front();
    const int flags = (frame.has_odometry ? kHasOdometry : 0) | (other ? kOtherSensor : 0);
    append_number(bytes, static_cast<std::uint8_t>(flags));
    append_number(bytes, frame.time_us);
    append_pose(bytes, frame.odom_T_robot);
    if (other) bytes += own;
    append_floats(bytes, frame.scan.ranges_m);
    sensor = std::move(own);
  }
}

std::vector<Frame> read_frames(ByteCursor& bytes, std::uint32_t /*version*/) {
  const auto count = bytes.number<std::uint64_t>();
  std::vector<Frame> frames;
  LaserScan sensor;
  for (std::uint64_t i = 0; i < count; ++i) {
    Frame frame;
    frame.index = frames.size();
    const auto flags = bytes.number<std::uint8_t>();
    if (flags > kAllFlags) throw MalformedBytes("a scan has an unknown mark");
    frame.has_odometry = (flags & kHasOdometry) != 0;
    frame.time_us = bytes.number<TimeUs>();
    frame.odom_T_robot = read_pose(bytes);
    if ((flags & kOtherSensor) != 0) read_sensor(bytes, sensor);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan has no sensor");
    frame.scan = sensor;
    frame.scan.ranges_m = read_floats(bytes);
    if (frame.scan.ranges_m.size() != frame.scan.bearings_rad->size())
      throw MalformedBytes("a scan has other beams than its sensor");
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace psi_slam
