// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "base/compression/byte_source.h"
#include "logs/frames/log_reader.h"
#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/bag_plan.h"

namespace psi_slam {

/// A bag that is still being recorded.
struct BagRecording {
  std::filesystem::path path;    ///< for messages
  std::unique_ptr<BagFile> bag;  ///< its messages
  /// Called when the first messages have decided which topics and frames are read; may be empty.
  std::function<void(const BagPlan&)> planned{};
};

/// Reads a ROS 1 bag or an MCAP file while it is recorded. The bag ends where the bytes end, also within a
/// message. Returns null if there are no bytes at all. Throws UserError as follow_ros1_bag() does.
std::unique_ptr<BagFile> follow_record_bag(std::unique_ptr<ByteSource> recording);

/// Reads a bag while it is recorded. The messages until `look_over_s` seconds after the first scan, see
/// LookOver, decide how the bag is read: topics of scans and odometry, mounts, the robot's frame, and the
/// gyroscope. The function waits for these messages. If the rest of the bag does not change these decisions,
/// the frames equal those of the complete bag, as long as odometry is at most 100 scans late.
///
/// Skips damaged messages and chunks. Throws UserError as open_bag_log().
std::unique_ptr<LogReader> open_followed_bag(std::unique_ptr<BagRecording> recording,
                                             const LogOptions& options, double look_over_s);

/// Calls open_followed_bag() with the bag of follow_record_bag(). Throws UserError if there are no bytes.
std::unique_ptr<LogReader> open_rosbag_stream(std::unique_ptr<ByteSource> recording,
                                              const LogOptions& options, double look_over_s);

}  // namespace psi_slam
