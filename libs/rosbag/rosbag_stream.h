// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "compression/byte_source.h"
#include "frames/log_reader.h"

namespace psi_slam {

/// Reads a ROS 1 bag or an MCAP file while it is recorded. The messages until `look_over_s` seconds after the
/// first scan, see LookOver, decide how the bag is read: topics of scans and odometry, mounts, the robot's
/// frame, and the gyroscope. The function waits for these messages. If the rest of the bag does not change
/// these decisions, the frames equal those of the complete bag, as long as odometry is at most 100 scans
/// late. The bag ends where the bytes end, also within a message.
///
/// Skips damaged messages. Throws UserError as open_bag_log().
std::unique_ptr<LogReader> open_rosbag_stream(std::unique_ptr<ByteSource> recording,
                                              const LogOptions& options, double look_over_s);

}  // namespace psi_slam
