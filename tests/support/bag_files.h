// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that write a recording of a robot as a CARMEN log or as a ROS 2 bag, in SQLite or MCAP. They
// follow the format specifications and use no ROS library. For ROS 1 bags see ros1_files.h.
#pragma once

#include <lz4frame.h>
#include <mrpt/math/TPose3D.h>
#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "test_files.h"
#include "zstd_files.h"

namespace psi_slam {

struct RecordedScan {
  std::string topic = "/scan";
  TimeUs time_us = 0;
  std::string frame = "laser";
  float angle_min_rad = -1;
  float angle_increment_rad = 0.5F;
  std::vector<float> ranges_m{1, 2, 3, 4, 5};
  float range_min_m = 0.1F;
  float range_max_m = 30;
  float time_increment_s = 0;
  float scan_time_s = 0.1F;
  bool multi_echo = false;  // a MultiEchoLaserScan: each beam has a second echo 1 m beyond its range
};

/// An odometry message, or a transform if the topic contains "/tf".
struct RecordedPose {
  std::string topic = "/odom";
  TimeUs time_us = 0;
  std::string frame = "odom";
  std::string child_frame = "base_link";
  mrpt::math::TPose3D pose;

  bool is_transform() const { return topic.find("/tf") != std::string::npos; }
};

struct RecordedImu {
  std::string topic = "/imu";
  TimeUs time_us = 0;
  std::string frame = "imu";
  std::array<double, 3> rate_radps{};
  bool has_rate = true;  // false: the message states that it has no angular velocity
};

struct RecordedCloud {
  std::string topic = "/points";
  TimeUs time_us = 0;
  std::string frame = "lidar";
  std::vector<std::array<double, 3>> points;  // their number is a multiple of `rows`
  std::uint32_t rows = 1;
  bool doubles = false;     // float64 coordinates instead of float32
  bool big_endian = false;  // byte order of the points
};

using Recorded = std::variant<RecordedScan, RecordedPose, RecordedImu, RecordedCloud>;
using Recording = std::vector<Recorded>;

inline const std::string& topic_of(const Recorded& message) {
  return std::visit([](const auto& m) -> const std::string& { return m.topic; }, message);
}

inline TimeUs time_of(const Recorded& message) {
  return std::visit([](const auto& m) { return m.time_us; }, message);
}

inline std::string ros2_type_of(const Recorded& message) {
  if (const auto* scan = std::get_if<RecordedScan>(&message))
    return scan->multi_echo ? "sensor_msgs/msg/MultiEchoLaserScan" : "sensor_msgs/msg/LaserScan";
  if (const auto* pose = std::get_if<RecordedPose>(&message))
    return pose->is_transform() ? "tf2_msgs/msg/TFMessage" : "nav_msgs/msg/Odometry";
  return std::holds_alternative<RecordedImu>(message) ? "sensor_msgs/msg/Imu" : "sensor_msgs/msg/PointCloud2";
}

/// Static transform from base_link to a laser 0.2 m ahead and 0.4 m above, turned left by 0.3 rad.
inline RecordedPose static_mount(const std::string& frame = "laser",
                                 const mrpt::math::TPose3D& pose = {0.2, 0, 0.4, 0.3, 0, 0}) {
  return {"/tf_static", 1'000'000'000'000'000, "base_link", frame, pose};
}

/// Recording of a run along a curve: odometry every 20 ms, a scan every 50 ms.
inline Recording recorded_run(int scans = 20) {
  Recording recording{static_mount()};
  constexpr TimeUs kStart = 1'600'000'000'000'000;
  for (TimeUs t = 0; t < scans * TimeUs{50'000} + 20'000; t += 10'000) {
    if (t % 50'000 == 0 && t < scans * TimeUs{50'000}) {
      RecordedScan scan;
      scan.time_us = kStart + t + 3'000;
      for (std::size_t i = 0; i < scan.ranges_m.size(); ++i)
        scan.ranges_m[i] += static_cast<float>(t) * 1e-6F + 0.1F * static_cast<float>(i);
      recording.emplace_back(scan);
    }
    if (t % 20'000 == 0) {
      const double way_m = 0.5 * seconds(t);
      recording.emplace_back(RecordedPose{
          "/odom", kStart + t, "odom", "base_link", {way_m, way_m * way_m, 0, 0.7 * way_m, 0, 0}});
    }
  }
  return recording;
}

/// Returns the pose as x, y, z in metres and the components x, y, z, w of its unit quaternion.
inline std::array<double, 7> place_and_quaternion(const mrpt::math::TPose3D& pose) {
  const double cy = std::cos(pose.yaw / 2), sy = std::sin(pose.yaw / 2);
  const double cp = std::cos(pose.pitch / 2), sp = std::sin(pose.pitch / 2);
  const double cr = std::cos(pose.roll / 2), sr = std::sin(pose.roll / 2);
  return {pose.x,
          pose.y,
          pose.z,
          sr * cp * cy - cr * sp * sy,
          cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

inline std::string lz4_frame(const std::string& bytes) {
  std::string frame(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  frame.resize(LZ4F_compressFrame(frame.data(), frame.size(), bytes.data(), bytes.size(), nullptr));
  return frame;
}

// ---- CDR ----

/// Writes a ROS 2 message in CDR, in either byte order. Each number is aligned to its size, counted from the
/// end of the header of four bytes.
class CdrWriter {
 public:
  explicit CdrWriter(bool little_endian = true) : little_endian_(little_endian) {}

  template <class Number>
  void number(Number value) {
    bytes_.append((sizeof value - bytes_.size() % sizeof value) % sizeof value, '\0');
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    if (little_endian_) {
      bytes_.append(raw.begin(), raw.end());
    } else {
      bytes_.append(raw.rbegin(), raw.rend());
    }
  }

  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value + '\0';
  }

  void bytes(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
  }

  void header(TimeUs time_us, const std::string& frame) {
    number(static_cast<std::int32_t>(time_us / 1'000'000));
    number(static_cast<std::uint32_t>(time_us % 1'000'000 * 1000));
    text(frame);
  }

  void pose(const mrpt::math::TPose3D& pose) {
    for (const double value : place_and_quaternion(pose)) number(value);
  }

  std::string message() const { return std::string{'\0', little_endian_ ? '\1' : '\0', '\0', '\0'} + bytes_; }

 private:
  bool little_endian_;
  std::string bytes_;
};

/// Returns the number of echoes that a message states before a range: none for a LaserScan.
inline std::vector<std::uint32_t> echo_counts(const RecordedScan& scan) {
  return scan.multi_echo ? std::vector<std::uint32_t>{2} : std::vector<std::uint32_t>();
}

inline std::string cdr(const RecordedScan& scan, bool little_endian) {
  CdrWriter cdr(little_endian);
  cdr.header(scan.time_us, scan.frame);
  const float angle_max =
      scan.angle_min_rad + scan.angle_increment_rad * static_cast<float>(scan.ranges_m.size() - 1);
  for (const float value : {scan.angle_min_rad, angle_max, scan.angle_increment_rad, scan.time_increment_s,
                            scan.scan_time_s, scan.range_min_m, scan.range_max_m})
    cdr.number(value);
  cdr.number(static_cast<std::uint32_t>(scan.ranges_m.size()));
  for (const float range : scan.ranges_m) {
    for (const std::uint32_t echoes : echo_counts(scan)) cdr.number(echoes);
    cdr.number(range);
    if (scan.multi_echo) cdr.number(range + 1);
  }
  cdr.number(std::uint32_t{0});  // no intensities
  return cdr.message();
}

inline std::string cdr(const RecordedPose& pose, bool little_endian) {
  CdrWriter cdr(little_endian);
  if (pose.is_transform()) cdr.number(std::uint32_t{1});
  cdr.header(pose.time_us, pose.frame);
  cdr.text(pose.child_frame);
  cdr.pose(pose.pose);
  if (!pose.is_transform())
    for (int i = 0; i < 36 + 6 + 36; ++i) cdr.number(0.0);  // covariance, twist
  return cdr.message();
}

/// Returns the 37 numbers of an IMU message after its header.
inline std::vector<double> numbers_of(const RecordedImu& imu) {
  std::vector<double> numbers(4 + 9 + 3 + 9 + 3 + 9, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) numbers[13 + axis] = imu.rate_radps[axis];
  numbers[16] = imu.has_rate ? 0.01 : -1;
  return numbers;
}

inline std::string cdr(const RecordedImu& imu, bool little_endian) {
  CdrWriter cdr(little_endian);
  cdr.header(imu.time_us, imu.frame);
  for (const double value : numbers_of(imu)) cdr.number(value);
  return cdr.message();
}

/// Bytes of a cloud's points. Each point has an intensity, then z, x and y, then a spare byte. Two spare
/// bytes follow each row.
struct CloudBytes {
  explicit CloudBytes(const RecordedCloud& cloud)
      : size(cloud.doubles ? 8 : 4),
        columns(static_cast<std::uint32_t>(cloud.points.size()) / cloud.rows),
        point_bytes(4 + 3 * size + 1),
        row_bytes(columns * point_bytes + 2) {
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      data += std::string(4, '\0');
      for (const std::size_t axis : {2U, 0U, 1U}) add(cloud.points[i][axis], cloud);
      data += '\0';
      if ((i + 1) % columns == 0) data += std::string(2, '\0');
    }
  }

  struct Field {
    std::string name;
    std::uint32_t offset;
    std::uint8_t type;
  };
  std::vector<Field> fields() const {
    const std::uint8_t type = size == 8 ? 8 : 7;
    return {{"intensity", 0, 7}, {"z", 4, type}, {"x", 4 + size, type}, {"y", 4 + 2 * size, type}};
  }

  std::uint32_t size;  // of a coordinate
  std::uint32_t columns;
  std::uint32_t point_bytes;
  std::uint32_t row_bytes;
  std::string data;

 private:
  void add(double value, const RecordedCloud& cloud) {
    const auto single = static_cast<float>(value);
    std::string raw(size, '\0');
    std::memcpy(raw.data(), cloud.doubles ? static_cast<const void*>(&value) : &single, size);
    if (cloud.big_endian) raw = std::string(raw.rbegin(), raw.rend());
    data += raw;
  }
};

inline std::string cdr(const RecordedCloud& cloud, bool little_endian) {
  CdrWriter cdr(little_endian);
  const CloudBytes content(cloud);
  cdr.header(cloud.time_us, cloud.frame);
  cdr.number(cloud.rows);
  cdr.number(content.columns);
  cdr.number(static_cast<std::uint32_t>(content.fields().size()));
  for (const CloudBytes::Field& field : content.fields()) {
    cdr.text(field.name);
    cdr.number(field.offset);
    cdr.number(field.type);
    cdr.number(std::uint32_t{1});
  }
  cdr.number(std::uint8_t{cloud.big_endian});
  cdr.number(content.point_bytes);
  cdr.number(content.row_bytes);
  cdr.bytes(content.data);
  cdr.number(std::uint8_t{1});
  return cdr.message();
}

inline std::string cdr(const Recorded& message, bool little_endian = true) {
  return std::visit([&](const auto& m) { return cdr(m, little_endian); }, message);
}

// ---- SQLite ----

/// Writes the database of a ROS 2 bag. As rosbag2, it does not wait for the locks of other programs: a lock
/// is an exception.
class Db3Writer {
 public:
  /// Creates the file. Each of `pragmas` is a setting such as "journal_mode=MEMORY".
  explicit Db3Writer(const std::filesystem::path& path, const std::vector<std::string>& pragmas = {})
      : database_(nullptr, &sqlite3_close) {
    std::filesystem::remove(path);
    sqlite3* database = nullptr;
    const int code = sqlite3_open(path.c_str(), &database);
    database_.reset(database);
    if (code != SQLITE_OK) throw std::runtime_error("cannot write " + path.string());
    for (const std::string& pragma : pragmas)
      if (sqlite3_exec(database, ("PRAGMA " + pragma).c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
        fail();
  }

  void create_tables() {
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT "
        "NULL, data BLOB NOT NULL)");
    run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  }

  /// Begins a transaction. `kind`: for example EXCLUSIVE.
  void begin(const std::string& kind = "") { run("BEGIN " + kind); }
  void commit() { run("COMMIT"); }

  /// Adds a message, and before the first one of a topic the topic. `bytes` are those of the message.
  void add(const Recorded& message, const std::string& bytes) {
    const auto [id, is_new] = ids_.emplace(topic_of(message), ids_.size() + 1);
    if (is_new)
      run("INSERT INTO topics VALUES (" + std::to_string(id->second) + ", '" + id->first + "', '" +
          ros2_type_of(message) + "', 'cdr', '')");
    run("INSERT INTO messages (topic_id, timestamp, data) VALUES (" + std::to_string(id->second) + ", " +
            std::to_string(time_of(message) * 1000) + ", ?)",
        bytes);
  }

 private:
  void run(const std::string& text, const std::string& blob = {}) {
    sqlite3_stmt* prepared = nullptr;
    if (sqlite3_prepare_v2(database_.get(), text.c_str(), -1, &prepared, nullptr) != SQLITE_OK) fail();
    const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(prepared, &sqlite3_finalize);
    sqlite3_bind_blob(prepared, 1, blob.data(), static_cast<int>(blob.size()), SQLITE_STATIC);
    if (sqlite3_step(prepared) != SQLITE_DONE) fail();
  }

  [[noreturn]] void fail() const { throw std::runtime_error(sqlite3_errmsg(database_.get())); }

  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
  std::map<std::string, std::size_t> ids_;  // of the topics
};

/// `compresses_messages`: rosbag2's compression mode "message".
inline void write_db3(const std::filesystem::path& path, const Recording& recording,
                      bool little_endian = true, bool compresses_messages = false) {
  Db3Writer writer(path);
  writer.create_tables();
  writer.begin();
  for (const Recorded& message : recording) {
    const std::string bytes = cdr(message, little_endian);
    writer.add(message, compresses_messages ? zstd_frame(bytes) : bytes);
  }
  writer.commit();
}

// ---- MCAP ----

struct McapLayout {
  std::string compression;             ///< "", "lz4" or "zstd"
  std::size_t messages_per_chunk = 7;  ///< 0: no chunks
  bool with_summary = true;
  bool little_endian = true;
  bool compresses_messages = false;  ///< rosbag2's compression mode "message"
};

class McapBytesWriter {
 public:
  explicit McapBytesWriter(const McapLayout& layout) : layout_(layout) {
    file_ = "\x89MCAP0\r\n";
    record(file_, 0x01, packed_text("ros2") + packed_text("test"));
  }

  void add(const Recorded& message) {
    const auto [channel, is_new] = channels_.emplace(topic_of(message), channels_.size() + 1);
    const auto id = static_cast<std::uint16_t>(channel->second);
    if (is_new) {
      std::string told;
      record(told, 0x03,
             packed(id) + packed_text(ros2_type_of(message)) + packed_text("ros2msg") + packed_text(""));
      record(told, 0x04,
             packed(id) + packed(id) + packed_text(channel->first) + packed_text("cdr") +
                 packed(std::uint32_t{0}));
      chunk_ += told;
      summary_ += told;
    }
    const auto time_ns = static_cast<std::uint64_t>(time_of(message)) * 1000;
    const std::string bytes = cdr(message, layout_.little_endian);
    record(chunk_, 0x05,
           packed(id) + packed(std::uint32_t{0}) + packed(time_ns) + packed(time_ns) +
               (layout_.compresses_messages ? zstd_frame(bytes) : bytes));
    if (++in_chunk_ >= layout_.messages_per_chunk) end_chunk();
  }

  std::string finish() {
    end_chunk();
    record(file_, 0x0F, packed(std::uint32_t{0}));
    const std::uint64_t summary_start = layout_.with_summary ? file_.size() : 0;
    if (layout_.with_summary) file_ += summary_;
    record(file_, 0x02, packed(summary_start) + packed(std::uint64_t{0}) + packed(std::uint32_t{0}));
    return file_ + "\x89MCAP0\r\n";
  }

 private:
  template <class Number>
  static std::string packed(Number value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
  }

  static std::string packed_text(const std::string& text) {
    return packed(static_cast<std::uint32_t>(text.size())) + text;
  }

  static void record(std::string& file, char kind, const std::string& bytes) {
    file += kind + packed(std::uint64_t{bytes.size()}) + bytes;
  }

  std::string compressed() const {
    if (layout_.compression == "zstd") return zstd_frame(chunk_);
    if (layout_.compression == "lz4") return lz4_frame(chunk_);
    return chunk_;
  }

  void end_chunk() {
    if (layout_.messages_per_chunk == 0) {
      file_ += chunk_;
    } else if (!chunk_.empty()) {
      const std::string bytes = compressed();
      record(file_, 0x06,
             packed(std::uint64_t{0}) + packed(std::uint64_t{0}) + packed(std::uint64_t{chunk_.size()}) +
                 packed(std::uint32_t{0}) + packed_text(layout_.compression) +
                 packed(std::uint64_t{bytes.size()}) + bytes);
    }
    chunk_.clear();
    in_chunk_ = 0;
  }

  McapLayout layout_;
  std::string file_;
  std::string chunk_;
  std::string summary_;
  std::size_t in_chunk_ = 0;
  std::map<std::string, std::size_t> channels_;
};

inline void write_mcap(const std::filesystem::path& path, const Recording& recording,
                       const McapLayout& layout = {}) {
  McapBytesWriter writer(layout);
  for (const Recorded& message : recording) writer.add(message);
  write_file(path, writer.finish());
}

// ---- CARMEN ----

/// Writes scans and odometry as RAWLASER1 and ODOM lines. These lines do not state the mount of the laser, so
/// the settings of the reader must.
inline void write_carmen(const std::filesystem::path& path, const Recording& recording) {
  std::string log = "# the same recording\n";
  const auto add = [&log](double value) {
    char text[40];
    std::snprintf(text, sizeof text, " %.17g", value);
    log += text;
  };
  for (const Recorded& message : recording) {
    if (const auto* scan = std::get_if<RecordedScan>(&message)) {
      const double step_rad = static_cast<double>(scan->angle_increment_rad);
      log += "RAWLASER1 0";
      add(static_cast<double>(scan->angle_min_rad));
      add(step_rad * static_cast<double>(scan->ranges_m.size() - 1));
      add(step_rad);
      add(static_cast<double>(scan->range_max_m));
      log += " 0.01 0 " + std::to_string(scan->ranges_m.size());
      for (const float range : scan->ranges_m) add(static_cast<double>(range));
      log += " 0";
    } else if (const auto* pose = std::get_if<RecordedPose>(&message); pose && !pose->is_transform()) {
      log += "ODOM";
      for (const double value : {pose->pose.x, pose->pose.y, pose->pose.yaw, 0.0, 0.0, 0.0}) add(value);
    } else {
      continue;
    }
    const std::string stamp = format_seconds(time_of(message));
    log += ' ' + stamp + " host " + stamp + '\n';
  }
  write_file(path, log);
}

}  // namespace psi_slam
