// SPDX-License-Identifier: BSD-3-Clause
// Interface to the containers of ROS bags: ROS 1 bags, ROS 2 bags in SQLite or MCAP files, and folders of the
// latter.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Encoding of the bytes of a message.
enum class BagEncoding { kRos1, kCdr, kOther };

struct BagTopic {
  std::string name;  ///< "/scan"
  std::string type;  ///< name in ROS 1, for ROS 2 bags too: "sensor_msgs/LaserScan"
  BagEncoding encoding = BagEncoding::kOther;
  bool operator==(const BagTopic& other) const {
    return name == other.name && type == other.type && encoding == other.encoding;
  }
};

/// Removes the "/msg" that ROS 2 inserts into type names.
std::string ros1_type_name(std::string_view type);

/// Appends a topic unless the list contains it.
void add_topic(std::vector<BagTopic>& topics, const BagTopic& topic);

/// One message. Pointer and view are valid until the next message is read.
struct BagMessage {
  const BagTopic* topic = nullptr;
  TimeUs recorded_us = 0;
  std::string_view bytes;
};

/// Reads a bag from its beginning, in the order of the file.
class BagFile {
 public:
  virtual ~BagFile() = default;

  /// Returns all topics before any message is read. For a damaged bag, those of its readable part.
  virtual std::vector<BagTopic> topics() = 0;

  /// Selects the topics of the messages to read; the default is all. Call before the first next().
  virtual void want(const std::vector<std::string>& topics) { wanted_ = topics; }

  /// Returns false at the end. Throws UserError (file, place) where the bag is damaged or truncated.
  virtual bool next(BagMessage& message) = 0;

  /// Fraction that has been read, in [0, 1].
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

/// Opens a bag of any container: a file, or the folder of a ROS 2 bag with its files in order. The content
/// decides. Throws UserError if it is no bag.
std::unique_ptr<BagFile> open_bag(const std::filesystem::path& path);

/// Opens a ROS 1 bag, version 2.0 (http://wiki.ros.org/Bags/Format/2.0): records of header fields and data,
/// most of them in chunks that may be compressed (bz2, lz4). Reading starts at the front; the index at the
/// end only provides the topics. A bag whose recorder was killed is thus read as far as it goes.
std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& path);

/// Opens an MCAP file of ROS 2 (https://mcap.dev/spec): records with one byte of kind and eight of length,
/// most of them in chunks that may be compressed (lz4, zstd). Reading starts at the front; the summary at the
/// end only provides the topics. ROS 1 messages in such a file are read too.
std::unique_ptr<BagFile> open_mcap_bag(const std::filesystem::path& path);

/// Opens an SQLite file (.db3) of ROS 2: a table of topics and a table of messages, which are read in the
/// order in which they were recorded.
std::unique_ptr<BagFile> open_sqlite_bag(const std::filesystem::path& path);

}  // namespace psi_slam
