// SPDX-License-Identifier: BSD-3-Clause
// Chooses among topics of odometry by the beginning of a bag, in the same way for a complete bag and for one
// that is still being recorded.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "logs/frames/look_over.h"
#include "logs/rosbag/ros_messages.h"

namespace psi_slam {

/// Finds the topics of odometry from which a bag is read. A single topic counts from its first message. Of
/// several, those are candidates that have a message before LookOver has enough scans: a bag that is still
/// being recorded shows nothing later. If none has, the topics are candidates that have a message within the
/// same time after the first odometry.
class HeardOdometry {
 public:
  HeardOdometry(std::vector<std::string> topics, double look_over_s);

  /// Takes a scan of any topic, by the time at which it was recorded.
  void add_scan(TimeUs recorded_us);
  void add(const std::string& topic, const RosTransform& odometry);

  /// Returns whether LookOver has enough scans.
  bool is_over() const { return heard_.is_enough(); }

  /// Returns whether more messages change nothing.
  bool is_complete() const { return !first_.empty() && (scans_without_.size() == 1 || heard_.is_enough()); }

  /// First odometry of each topic that spoke.
  const std::map<std::string, RosTransform>& first() const { return first_; }

  /// Returns whether more than half of the scans came during one silence of a topic.
  bool is_silent(const std::string& topic) const;

 private:
  struct Scans {
    std::size_t since_odometry = 0;
    std::size_t longest_silence = 0;
  };

  double look_over_s_;
  LookOver heard_;
  std::map<std::string, RosTransform> first_;
  std::size_t scans_ = 0;
  std::map<std::string, Scans> scans_without_;  // key: topic
};

}  // namespace psi_slam
