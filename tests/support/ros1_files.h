// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that write recordings as ROS 1 bags. They follow the format specification, whereas
// write_ros1_bag.py in tests/logs/rosbag writes bags with ROS's own library.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "bag_files.h"

namespace psi_slam {

template <class Number>
std::string ros1_packed(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

inline std::string ros1_text(const std::string& text) {
  return ros1_packed(static_cast<std::uint32_t>(text.size())) + text;
}

inline std::string ros1_time(TimeUs time_us) {
  return ros1_packed(static_cast<std::uint32_t>(time_us / 1'000'000)) +
         ros1_packed(static_cast<std::uint32_t>(time_us % 1'000'000 * 1000));
}

inline std::string ros1_header(TimeUs time_us, const std::string& frame) {
  return ros1_packed(std::uint32_t{0}) + ros1_time(time_us) + ros1_text(frame);
}

inline std::string ros1_message(const RecordedScan& scan) {
  std::string bytes = ros1_header(scan.time_us, scan.frame);
  for (const float value : {scan.angle_min_rad, 0.0F, scan.angle_increment_rad, scan.time_increment_s,
                            scan.scan_time_s, scan.range_min_m, scan.range_max_m})
    bytes += ros1_packed(value);
  bytes += ros1_packed(static_cast<std::uint32_t>(scan.ranges_m.size()));
  for (const float range : scan.ranges_m) {
    for (const std::uint32_t echoes : echo_counts(scan)) bytes += ros1_packed(echoes);
    bytes += ros1_packed(range);
    if (scan.multi_echo) bytes += ros1_packed(range + 1);
  }
  return bytes + ros1_packed(std::uint32_t{0});
}

inline std::string ros1_message(const RecordedPose& pose) {
  std::string bytes = pose.is_transform() ? ros1_packed(std::uint32_t{1}) : std::string();
  bytes += ros1_header(pose.time_us, pose.frame) + ros1_text(pose.child_frame);
  for (const double value : place_and_quaternion(pose.pose)) bytes += ros1_packed(value);
  return pose.is_transform() ? bytes : bytes + std::string((36 + 6 + 36) * sizeof(double), '\0');
}

inline std::string ros1_message(const RecordedImu& imu) {
  std::string bytes = ros1_header(imu.time_us, imu.frame);
  for (const double value : numbers_of(imu)) bytes += ros1_packed(value);
  return bytes;
}

inline std::string ros1_message(const RecordedCloud& cloud) {
  const CloudBytes content(cloud);
  std::string bytes = ros1_header(cloud.time_us, cloud.frame) + ros1_packed(cloud.rows) +
                      ros1_packed(content.columns) +
                      ros1_packed(static_cast<std::uint32_t>(content.fields().size()));
  for (const CloudBytes::Field& field : content.fields())
    bytes += ros1_text(field.name) + ros1_packed(field.offset) + ros1_packed(field.type) +
             ros1_packed(std::uint32_t{1});
  return bytes + ros1_packed(std::uint8_t{cloud.big_endian}) + ros1_packed(content.point_bytes) +
         ros1_packed(content.row_bytes) + ros1_text(content.data) + ros1_packed(std::uint8_t{1});
}

inline std::string ros1_message(const Recorded& message) {
  return std::visit([](const auto& m) { return ros1_message(m); }, message);
}

struct Ros1Layout {
  std::string compression = "none";  ///< "none", "bz2" or "lz4"
  std::size_t messages_per_chunk = 7;
  bool is_closed = true;     ///< false: no index, as after a recorder was killed
  bool states_sizes = true;  ///< false: as the recorder writes chunks before it completes them
};

class Ros1Writer {
 public:
  explicit Ros1Writer(const Ros1Layout& layout) : layout_(layout) {}

  void add(const Recorded& message) {
    const auto [connection, is_new] = connections_.emplace(topic_of(message), connections_.size());
    const std::string number = ros1_packed(static_cast<std::uint32_t>(connection->second));
    if (is_new) {
      const std::string told =
          record({{"op", "\x07"}, {"conn", number}, {"topic", connection->first}},
                 fields({{"topic", connection->first}, {"type", ros1_type_of(message)}, {"md5sum", "*"}}));
      chunk_ += told;
      index_ += told;
    }
    chunk_ += record({{"op", "\x02"}, {"conn", number}, {"time", ros1_time(time_of(message))}},
                     ros1_message(message));
    if (++in_chunk_ >= layout_.messages_per_chunk) end_chunk();
  }

  std::string finish() {
    end_chunk();
    const std::string magic = "#ROSBAG V2.0\n";
    const auto header = [&](std::uint64_t index_pos) {
      return magic + record({{"op", "\x03"},
                             {"index_pos", ros1_packed(index_pos)},
                             {"conn_count", ros1_packed(static_cast<std::uint32_t>(connections_.size()))},
                             {"chunk_count", ros1_packed(chunks_)}},
                            std::string(100, ' '));
    };
    if (!layout_.is_closed) return header(0) + file_;
    return header(header(0).size() + file_.size()) + file_ + index_;
  }

 private:
  using Fields = std::initializer_list<std::pair<std::string, std::string>>;

  static std::string ros1_type_of(const Recorded& message) {
    std::string type = ros2_type_of(message);
    return type.erase(type.find("/msg"), 4);
  }

  static std::string fields(Fields fields) {
    std::string bytes;
    for (const auto& [name, value] : fields) bytes += ros1_text(name + "=" + value);
    return bytes;
  }

  static std::string record(Fields header, const std::string& data) {
    return ros1_text(fields(header)) + ros1_text(data);
  }

  std::string compressed() const {
    if (layout_.compression == "lz4") return lz4_frame(chunk_);
    if (layout_.compression != "bz2") return chunk_;
    std::string input = chunk_;
    auto size = static_cast<unsigned>(chunk_.size() * 2 + 600);
    std::string bytes(size, '\0');
    if (BZ2_bzBuffToBuffCompress(bytes.data(), &size, input.data(), static_cast<unsigned>(input.size()), 9, 0,
                                 0) != BZ_OK)
      throw std::runtime_error("bz2 does not compress");
    bytes.resize(size);
    return bytes;
  }

  void end_chunk() {
    if (chunk_.empty()) return;
    const std::size_t size = layout_.states_sizes ? chunk_.size() : 0;
    file_ += record({{"op", "\x05"},
                     {"compression", layout_.compression},
                     {"size", ros1_packed(static_cast<std::uint32_t>(size))}},
                    layout_.states_sizes ? compressed() : "");
    if (!layout_.states_sizes) file_ += compressed();
    file_ += record({{"op", "\x04"}, {"ver", ros1_packed(std::uint32_t{1})}}, std::string(24, '\0'));
    ++chunks_;
    chunk_.clear();
    in_chunk_ = 0;
  }

  Ros1Layout layout_;
  std::string file_;
  std::string chunk_;
  std::string index_;
  std::size_t in_chunk_ = 0;
  std::uint32_t chunks_ = 0;
  std::map<std::string, std::size_t> connections_;
};

inline void write_ros1_bag(const std::filesystem::path& path, const Recording& recording,
                           const Ros1Layout& layout = {}) {
  Ros1Writer writer(layout);
  for (const Recorded& message : recording) writer.add(message);
  write_file(path, writer.finish());
}

}  // namespace psi_slam
