// SPDX-License-Identifier: BSD-3-Clause
// Interface to the containers of ROS bags: ROS 1 bags, ROS 2 bags in SQLite or MCAP files, and the folders of
// ROS 2 bags.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_cursor.h"
#include "base/compression/byte_source.h"
#include "logs/rosbag/bag_recorder.h"
#include "psi_slam/time_stamp.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Encoding of the bytes of a message.
enum class BagEncoding { kRos1, kCdr, kOther };

struct BagTopic {
  std::string name;  ///< such as "/scan"
  std::string type;  ///< ROS 1 name of the type, also for ROS 2 bags: "sensor_msgs/LaserScan"
  BagEncoding encoding = BagEncoding::kOther;
  std::int64_t number = 0;  ///< its number in the file, by which BagFile::topics() is sorted
  bool operator==(const BagTopic& other) const {
    return name == other.name && type == other.type && encoding == other.encoding;
  }
};

/// Returns the ROS 1 name of a type: removes the "/msg" that ROS 2 inserts.
std::string ros1_type_name(std::string_view type);

/// Returns the ROS 2 name of a type: inserts the "/msg" that the ROS 1 name lacks.
std::string ros2_type_name(std::string_view type);

/// Appends a topic unless the list contains it.
void add_topic(std::vector<BagTopic>& topics, const BagTopic& topic);

/// One message. `topic` and `bytes` are valid until the next message is read. The bytes are compressed if
/// rosbag2 compressed each message by itself (compression mode "message").
struct BagMessage {
  const BagTopic* topic = nullptr;
  TimeUs recorded_us = 0;
  std::string_view bytes;
};

/// Largest record, chunk or message that is read, compressed or not. Recorders write chunks of a few
/// megabytes; anything larger than this limit is taken for damage, so that no bag takes all memory.
constexpr std::uint64_t kMaxRecordBytes = std::uint64_t{1} << 27;

/// Throws MalformedBytes if a bag states a size above kMaxRecordBytes.
void check_stated_size(std::uint64_t bytes);

/// Part of a bag that is damaged by itself, such as a chunk. The bag can be read further.
class DamagedPart : public UserError {
 public:
  using UserError::UserError;
};

/// Reads a bag from its beginning, in the order of the file.
class BagFile {
 public:
  virtual ~BagFile() = default;

  /// Returns all topics of the bag, also before any message is read. For a damaged bag, returns the topics of
  /// its readable part.
  virtual std::vector<BagTopic> topics() = 0;

  /// Selects the topics whose messages next() returns; by default all topics. Call before the first next(),
  /// or at any time for a bag that is still being recorded.
  virtual void want(const std::vector<std::string>& topics) { wanted_ = topics; }

  /// Reads the next message. Returns false at the end. Throws UserError, with file and place, where the bag
  /// is damaged or truncated. If it is a DamagedPart, the next call reads on after that part.
  virtual bool next(BagMessage& message) = 0;

  /// Fraction of the bag that has been read, in [0, 1].
  virtual double progress() const = 0;

  /// Place of the last message for error messages: "run.bag: byte 4117".
  virtual std::string place() const = 0;

 protected:
  const std::vector<std::string>& wanted() const { return wanted_; }
  bool is_wanted(const BagTopic& topic) const {
    return wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), topic.name) != wanted_.end();
  }

 private:
  std::vector<std::string> wanted_;
};

/// Error message for the last message of a bag, whose bytes are damaged.
std::string damage_text(const BagFile& bag, const BagMessage& message, const MalformedBytes& damage);

/// Opens a bag of any container: a file, or the folder of a ROS 2 bag, whose files are read in order. Each
/// file may be compressed as a whole, see CompressedFile. Recognises the container by the content. Throws
/// UserError if `path` is not a bag.
std::unique_ptr<BagFile> open_bag(const std::filesystem::path& path);

/// Opens a ROS 1 bag, version 2.0 (http://wiki.ros.org/Bags/Format/2.0). It consists of records of header
/// fields and data, most of them in chunks that may be compressed (bz2, lz4). Reading starts at the front;
/// the index at the end only provides the topics. So a bag whose recorder was killed can be read up to its
/// end.
std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& path);

/// Opens an MCAP file of ROS 2 (https://mcap.dev/spec). It consists of records with one byte of kind and
/// eight bytes of length, most of them in chunks that may be compressed (lz4, zstd). Reading starts at the
/// front; the summary at the end only provides the topics. ROS 1 messages in such a file are read too.
std::unique_ptr<BagFile> open_mcap_bag(const std::filesystem::path& path);

/// Read a bag while it is recorded. topics() and progress() must not be called. The bag ends where the bytes
/// end, also within a record. Throw UserError if the bytes do not begin like such a bag. A chunk of a ROS 1
/// bag that is still being recorded must not be compressed: next() throws UserError then.
std::unique_ptr<BagFile> follow_ros1_bag(std::unique_ptr<ByteSource> recording);
std::unique_ptr<BagFile> follow_mcap_bag(std::unique_ptr<ByteSource> recording);

/// Reads an SQLite file (.db3) while rosbag2 writes it, without a lock, so that the recorder never waits. The
/// bag ends when `recorder` is closed or stops the reader. topics() and progress() must not be called. Throws
/// UserError if the file cannot be opened.
std::unique_ptr<BagFile> follow_sqlite_bag(const std::filesystem::path& path, BagRecorder recorder);

/// Opens an SQLite file (.db3) of ROS 2, which has a table of topics and a table of messages. Messages are
/// read in the order in which they were written. A compressed file is unpacked into a temporary file while it
/// is read.
std::unique_ptr<BagFile> open_sqlite_bag(const std::filesystem::path& path);

}  // namespace psi_slam
