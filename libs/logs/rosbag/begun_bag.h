// SPDX-License-Identifier: BSD-3-Clause
// The beginning of a bag that is still being recorded.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// The first messages of a bag, which decide how it is read.
struct BeginningOfBag {
  struct Message {
    BagTopic topic;
    TimeUs recorded_us = 0;
    std::string bytes;
    std::string place;  ///< as BagFile::place()
  };

  std::vector<BagTopic> topics;  ///< of all messages, in the order of the complete bag
  /// Messages that a reader of scans needs, in the order of the bag: scans, odometry, transforms and readings
  /// of IMUs; point clouds only if the options select a slice of them.
  std::deque<Message> messages;
  std::vector<DamagedPart> damage;  ///< damaged parts, which BagFile::next() reports before all messages
};

/// Reads the first messages of a recording until LookOver has enough scans; the times are those at which
/// messages were recorded. Waits for these messages. Keeps at most 10,000 messages besides scans and static
/// transforms: of more, the oldest are dropped.
BeginningOfBag read_beginning(BagFile& recording, const LogOptions& options, double look_over_s);

/// Returns a bag of the messages of a beginning, and after them those of `rest` unless that is null.
std::unique_ptr<BagFile> begun_bag(std::shared_ptr<const BeginningOfBag> beginning,
                                   std::unique_ptr<BagFile> rest = nullptr);

}  // namespace psi_slam
