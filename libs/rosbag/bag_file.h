// SPDX-License-Identifier: BSD-3-Clause
// The one interface over the containers of ROS bags: ROS 1 bags, and ROS 2 bags in SQLite or MCAP files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// How the bytes of a message are to be read.
enum class BagEncoding { kRos1, kCdr, kOther };

struct BagTopic {
  std::string name;  ///< "/scan"
  std::string type;  ///< as ROS 1 names it, in ROS 2 too: "sensor_msgs/LaserScan"
  BagEncoding encoding = BagEncoding::kOther;
  bool operator==(const BagTopic& other) const {
    return name == other.name && type == other.type && encoding == other.encoding;
  }
};

/// The type without the "/msg" that ROS 2 puts into it.
std::string ros1_type_name(std::string_view type);

/// One message; what it refers to lives until the next is read.
struct BagMessage {
  const BagTopic* topic = nullptr;
  TimeUs recorded_us = 0;
  std::string_view bytes;
};

/// A bag being read from its beginning, its messages in the order of the file.
class BagFile {
 public:
  virtual ~BagFile() = default;

  /// All topics, found before any message is read. Of a damaged bag those of its readable part.
  virtual std::vector<BagTopic> topics() = 0;

  /// Only messages of these topics will be given; all if never called. Called before the first next().
  virtual void want(const std::vector<std::string>& topics) { wanted_ = topics; }

  /// False at the end. Throws UserError (file, place) where the bag is damaged or cut off.
  virtual bool next(BagMessage& message) = 0;

  /// In [0, 1].
  virtual double progress() const = 0;

  /// Where the last message stands, for sentences: "run.bag: byte 4117".
  virtual std::string place() const = 0;

 protected:
  const std::vector<std::string>& wanted() const { return wanted_; }
  bool is_wanted(const BagTopic& topic) const {
    return wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), topic.name) != wanted_.end();
  }

 private:
  std::vector<std::string> wanted_;
};

/// Opens a bag of any of the containers, which its content decides: a file, or the folder of a ROS 2 bag with
/// its files in their order. Throws UserError when it is none.
std::unique_ptr<BagFile> open_bag(const std::filesystem::path& path);

}  // namespace psi_slam
