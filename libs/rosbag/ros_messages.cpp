// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/ros_messages.h"

#include <mrpt/math/CQuaternion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/byte_cursor.h"
#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

/// Parses the fields of a message in order, in either encoding.
class RosFields {
 public:
  explicit RosFields(const BagMessage& message)
      : cdr_(message.topic->encoding == BagEncoding::kCdr), cursor_(cursor_over(message, alignment_)) {}

  bool is_cdr() const { return cdr_; }

  template <class Number>
  Number number() {
    if (cdr_) align(sizeof(Number));
    return cursor_.number<Number>();
  }

  std::string text() {
    const auto size = number<std::uint32_t>();
    std::string text(cursor_.take(size));
    if (cdr_ && !text.empty() && text.back() == '\0') text.pop_back();
    return text;
  }

  std::vector<float> floats() {
    const auto count = number<std::uint32_t>();
    if (count > cursor_.left() / sizeof(float))
      throw MalformedBytes("it states " + std::to_string(count) + " numbers, but only " +
                           std::to_string(cursor_.left()) + " bytes are left");
    std::vector<float> values(count);
    for (float& value : values) value = number<float>();
    return values;
  }

 private:
  /// Returns a cursor over the fields. Skips the four bytes before CDR data, which state the encoding, and
  /// sets `alignment` from them.
  static ByteCursor cursor_over(const BagMessage& message, std::size_t& alignment) {
    if (message.topic->encoding == BagEncoding::kRos1) return ByteCursor(message.bytes);
    ByteCursor head(message.bytes);
    head.take(1);
    const auto kind = head.number<std::uint8_t>();
    head.take(2);
    const bool is_plain_cdr2 = kind == 6 || kind == 7;
    if (kind > 1 && !is_plain_cdr2)
      throw MalformedBytes("its encoding has kind " + std::to_string(kind) + ", expected plain CDR");
    alignment = is_plain_cdr2 ? 4 : 8;
    return ByteCursor(head.rest(), kind % 2 == 1 ? ByteOrder::kLittleEndian : ByteOrder::kBigEndian);
  }

  void align(std::size_t size) {
    const std::size_t step = std::min(size, alignment_);
    cursor_.take((step - cursor_.offset() % step) % step);
  }

  // Largest alignment in bytes; set while cursor_ is initialised, so declared before it.
  std::size_t alignment_ = 8;
  bool cdr_;
  ByteCursor cursor_;
};

std::string frame_name(std::string name) {
  if (!name.empty() && name.front() == '/') name.erase(0, 1);
  return name;
}

RosHeader header(RosFields& fields, TimeUs recorded_us) {
  RosHeader header;
  if (!fields.is_cdr()) fields.number<std::uint32_t>();  // sequence number
  const std::int64_t stamp_s = fields.is_cdr() ? std::int64_t{fields.number<std::int32_t>()}
                                               : std::int64_t{fields.number<std::uint32_t>()};
  const auto stamp_ns = std::int64_t{fields.number<std::uint32_t>()};
  const bool is_stamped = stamp_s != 0 || stamp_ns != 0;
  header.time_us = is_stamped ? stamp_s * 1'000'000 + (stamp_ns + 500) / 1000 : recorded_us;
  header.frame = frame_name(fields.text());
  return header;
}

/// Parses a position and a quaternion x, y, z, w. Empty if odometry cannot measure the position, or if the
/// length of the quaternion is not 1.
std::optional<mrpt::math::TPose3D> pose(RosFields& fields) {
  double values[7];
  for (double& value : values) value = fields.number<double>();
  const auto [x, y, z, qx, qy, qz, qw] = values;
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!is_possible_odometry({x, y, 0}) || !std::isfinite(z) || !(std::abs(norm - 1) < 0.1))
    return std::nullopt;
  const mrpt::math::CQuaternionDouble rotation(qw / norm, qx / norm, qy / norm, qz / norm);
  mrpt::math::TPose3D pose(x, y, z, 0, 0, 0);
  rotation.rpy(pose.roll, pose.pitch, pose.yaw);
  return pose;
}

/// Parses a header, the name of a frame and its pose. Empty if the pose is invalid.
std::optional<RosTransform> transform(RosFields& fields, TimeUs recorded_us) {
  RosTransform transform;
  transform.header = header(fields, recorded_us);
  transform.child_frame = frame_name(fields.text());
  const auto valid_pose = pose(fields);
  if (!valid_pose) return std::nullopt;
  transform.pose = *valid_pose;
  return transform;
}

/// Parses a list of echoes for each beam, and returns the first echo of each; NaN if a beam has none.
std::vector<float> first_echoes(RosFields& fields) {
  std::vector<float> ranges_m;
  for (auto beams = fields.number<std::uint32_t>(); beams > 0; --beams) {
    const std::vector<float> echoes = fields.floats();
    ranges_m.push_back(echoes.empty() ? std::numeric_limits<float>::quiet_NaN() : echoes.front());
  }
  return ranges_m;
}

}  // namespace

RosLaserScan read_ros_laser_scan(const BagMessage& message) {
  RosFields fields(message);
  RosLaserScan scan;
  scan.header = header(fields, message.recorded_us);
  scan.angle_min_rad = fields.number<float>();
  fields.number<float>();  // angle_max, which follows from the other fields
  scan.angle_increment_rad = fields.number<float>();
  scan.time_increment_s = fields.number<float>();
  scan.scan_time_s = fields.number<float>();
  scan.range_min_m = fields.number<float>();
  scan.range_max_m = fields.number<float>();
  scan.ranges_m = message.topic->type == kRosMultiEchoScan ? first_echoes(fields) : fields.floats();
  return scan;
}

std::optional<RosTransform> read_ros_odometry(const BagMessage& message) {
  RosFields fields(message);
  return transform(fields, message.recorded_us);
}

std::vector<RosTransform> read_ros_transforms(const BagMessage& message) {
  RosFields fields(message);
  std::vector<RosTransform> transforms;
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left)
    if (auto valid = transform(fields, message.recorded_us)) transforms.push_back(*std::move(valid));
  return transforms;
}

}  // namespace psi_slam
