// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/ros_messages.h"

#include <mrpt/math/CQuaternion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/byte_cursor.h"
#include "base/compression/compression.h"
#include "base/compression/decompressor.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

/// Parses the fields of a message in order, in either encoding.
class RosFields {
 public:
  explicit RosFields(const BagMessage& message)
      : cdr_(message.topic->encoding == BagEncoding::kCdr), cursor_(cursor_over(message)) {}

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

  /// Takes an array of bytes, which stay in the message.
  std::string_view bytes() { return cursor_.take(number<std::uint32_t>()); }

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
  /// Returns a cursor over the fields. Decompresses CDR data that rosbag2 compressed. Skips the four bytes
  /// before the data, which state the encoding, and sets alignment_ from them.
  ByteCursor cursor_over(const BagMessage& message) {
    if (message.topic->encoding == BagEncoding::kRos1) return ByteCursor(message.bytes);
    const bool is_packed = compression_of(message.bytes) == "zstd";  // CDR starts with a byte 0
    if (is_packed) unpacked_ = decompress_zstd_frame(message.bytes, kMaxRecordBytes);
    ByteCursor head(is_packed ? unpacked_ : message.bytes);
    head.take(1);
    const auto kind = head.number<std::uint8_t>();
    head.take(2);
    const bool is_plain_cdr2 = kind == 6 || kind == 7;
    if (kind > 1 && !is_plain_cdr2)
      throw MalformedBytes("its encoding has kind " + std::to_string(kind) + ", expected plain CDR");
    alignment_ = is_plain_cdr2 ? 4 : 8;
    return ByteCursor(head.rest(), kind % 2 == 1 ? ByteOrder::kLittleEndian : ByteOrder::kBigEndian);
  }

  void align(std::size_t size) {
    const std::size_t step = std::min(size, alignment_);
    cursor_.take((step - cursor_.offset() % step) % step);
  }

  // Set while cursor_ is initialised, so declared before it: largest alignment in bytes, and decompressed
  // bytes of the message.
  std::size_t alignment_ = 8;
  std::string unpacked_;
  bool cdr_;
  ByteCursor cursor_;
};

std::string frame_name(std::string name) {
  if (!name.empty() && name.front() == '/') name.erase(0, 1);
  return name;
}

/// Parses a time, which is 0 in messages without a stamp.
TimeUs ros_time_us(RosFields& fields) {
  const std::int64_t stamp_s = fields.is_cdr() ? std::int64_t{fields.number<std::int32_t>()}
                                               : std::int64_t{fields.number<std::uint32_t>()};
  const auto stamp_ns = std::int64_t{fields.number<std::uint32_t>()};
  return stamp_s * 1'000'000 + (stamp_ns + 500) / 1000;
}

RosHeader header(RosFields& fields, TimeUs recorded_us) {
  RosHeader header;
  if (!fields.is_cdr()) fields.number<std::uint32_t>();  // sequence number
  const TimeUs stamp_us = ros_time_us(fields);
  header.time_us = stamp_us != 0 ? stamp_us : recorded_us;
  header.frame = frame_name(fields.text());
  return header;
}

/// Parses a position and a quaternion x, y, z, w. Empty if odometry cannot measure the position, or if the
/// length of the quaternion is not 1.
std::optional<mrpt::poses::CPose3D> pose(RosFields& fields) {
  double values[7];
  for (double& value : values) value = fields.number<double>();
  const auto [x, y, z, qx, qy, qz, qw] = values;
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!is_possible_odometry({x, y, 0}) || !std::isfinite(z) || !(std::abs(norm - 1) < 0.1))
    return std::nullopt;
  const mrpt::math::CQuaternionDouble rotation(qw / norm, qx / norm, qy / norm, qz / norm);
  // From the matrix, because MRPT computes angles with the C library.
  return mrpt::poses::CPose3D::FromRotationAndTranslation(
      rotation.rotationMatrix<mrpt::math::CMatrixDouble33>(), mrpt::math::TVector3D(x, y, z));
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

/// Where a coordinate is in the bytes of a point.
struct PointField {
  std::uint32_t offset = 0;
  std::uint8_t type = 0;
};

constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;

/// Layout of the points of a cloud. The data hold `height` rows of `width` points.
struct PointLayout {
  std::uint64_t height = 0;
  std::uint64_t width = 0;
  std::uint64_t point_bytes = 0;
  std::uint64_t row_bytes = 0;
  PointField coordinates[3];
};

/// Parses the list of a point's fields. Returns each field by its name.
std::map<std::string, PointField> point_fields(RosFields& fields) {
  std::map<std::string, PointField> found;
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left) {
    PointField& field = found[fields.text()];
    field.offset = fields.number<std::uint32_t>();
    field.type = fields.number<std::uint8_t>();
    fields.number<std::uint32_t>();  // number of values, 1 for a coordinate
  }
  return found;
}

void check_field(const std::string& name, const PointField& field, std::uint64_t point_bytes) {
  if (field.type != kFloat32 && field.type != kFloat64)
    throw MalformedBytes("the field " + name + " of its points has type " + std::to_string(field.type) +
                         ", expected 7 (float32) or 8 (float64)");
  if (field.offset + std::uint64_t{field.type == kFloat32 ? 4U : 8U} > point_bytes)
    throw MalformedBytes("the field " + name + " extends beyond its points, which have " +
                         std::to_string(point_bytes) + " bytes");
}

/// Throws MalformedBytes if the data are shorter than the points.
void check_size(const PointLayout& layout, std::size_t data_bytes) {
  const std::uint64_t row_bytes = layout.width * layout.point_bytes;
  const bool rows_overlap = layout.height > 1 && layout.row_bytes < row_bytes;
  if (row_bytes > data_bytes || rows_overlap ||
      (layout.height - 1) * layout.row_bytes > data_bytes - row_bytes)
    throw MalformedBytes("it states " + std::to_string(layout.height) + " rows of " +
                         std::to_string(layout.width) + " points, but has only " +
                         std::to_string(data_bytes) + " bytes of points");
}

float coordinate(std::string_view point, const PointField& field, ByteOrder order) {
  ByteCursor cursor(point.substr(field.offset), order);
  return field.type == kFloat32 ? cursor.number<float>() : static_cast<float>(cursor.number<double>());
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

RosPointCloud read_ros_point_cloud(const BagMessage& message) {
  RosFields fields(message);
  RosPointCloud cloud;
  cloud.header = header(fields, message.recorded_us);
  PointLayout layout;
  layout.height = fields.number<std::uint32_t>();
  layout.width = fields.number<std::uint32_t>();
  const auto found = point_fields(fields);
  const bool is_big_endian = fields.number<std::uint8_t>() != 0;
  layout.point_bytes = fields.number<std::uint32_t>();
  layout.row_bytes = fields.number<std::uint32_t>();
  const std::string_view data = fields.bytes();
  if (layout.height == 0 || layout.width == 0) return cloud;
  constexpr const char* kNames[3] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto field = found.find(kNames[axis]);
    if (field == found.end()) throw MalformedBytes(std::string("its points have no field ") + kNames[axis]);
    check_field(kNames[axis], field->second, layout.point_bytes);
    layout.coordinates[axis] = field->second;
  }
  check_size(layout, data.size());
  const ByteOrder order = is_big_endian ? ByteOrder::kBigEndian : ByteOrder::kLittleEndian;
  cloud.points.reserve(layout.height * layout.width);
  for (std::uint64_t row = 0; row < layout.height; ++row) {
    for (std::uint64_t column = 0; column < layout.width; ++column) {
      const std::string_view point =
          data.substr(row * layout.row_bytes + column * layout.point_bytes, layout.point_bytes);
      cloud.points.emplace_back(coordinate(point, layout.coordinates[0], order),
                                coordinate(point, layout.coordinates[1], order),
                                coordinate(point, layout.coordinates[2], order));
    }
  }
  return cloud;
}

RosImu read_ros_imu(const BagMessage& message) {
  constexpr int kOrientationNumbers = 4 + 9;  // a quaternion and its covariance
  constexpr double kNoData = -1;              // first number of the covariance
  RosFields fields(message);
  RosImu imu;
  imu.header = header(fields, message.recorded_us);
  for (int i = 0; i < kOrientationNumbers; ++i) fields.number<double>();
  mrpt::math::TVector3D rate_radps;
  for (double* const value : {&rate_radps.x, &rate_radps.y, &rate_radps.z}) *value = fields.number<double>();
  if (fields.number<double>() != kNoData) imu.rate_radps = rate_radps;
  return imu;
}

RosHeader read_ros_header(const BagMessage& message) {
  RosFields fields(message);
  return header(fields, message.recorded_us);
}

std::optional<RosTransform> read_ros_odometry(const BagMessage& message) {
  RosFields fields(message);
  return transform(fields, message.recorded_us);
}

mrpt::math::TPose2D on_floor(const mrpt::poses::CPose3D& pose) {
  constexpr double kSteps = 1e12;  // per radian
  const mrpt::math::CMatrixDouble33& rotation = pose.getRotationMatrix();
  return {pose.x(), pose.y(), std::round(portable::atan2(rotation(1, 0), rotation(0, 0)) * kSteps) / kSteps};
}

TimeUs read_ros_clock(const BagMessage& message) {
  RosFields fields(message);
  return ros_time_us(fields);
}

std::string read_ros_string(const BagMessage& message) {
  RosFields fields(message);
  return fields.text();
}

std::optional<mrpt::math::TPose2D> read_ros_pose(const BagMessage& message) {
  RosFields fields(message);
  header(fields, message.recorded_us);
  const auto valid_pose = pose(fields);
  if (!valid_pose) return std::nullopt;
  return on_floor(*valid_pose);
}

std::string invalid_pose_text(const std::string& topic) {
  return "the odometry on " + topic +
         " is not finite, or the length of its quaternion is not 1, or it is beyond 10,000 km";
}

std::vector<RosTransform> read_ros_transforms(const BagMessage& message) {
  RosFields fields(message);
  std::vector<RosTransform> transforms;
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left)
    if (auto valid = transform(fields, message.recorded_us)) transforms.push_back(*std::move(valid));
  return transforms;
}

}  // namespace psi_slam
