// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/heard_odometry.h"

#include <algorithm>

namespace psi_slam {

HeardOdometry::HeardOdometry(std::vector<std::string> topics, double look_over_s)
    : look_over_s_(look_over_s), heard_(look_over_s) {
  for (const std::string& topic : topics) scans_without_[topic];
}

void HeardOdometry::add_scan(TimeUs recorded_us) {
  if (is_complete()) return;
  heard_.add_scan(recorded_us);
  ++scans_;
  for (auto& [topic, scans] : scans_without_)
    scans.longest_silence = std::max(scans.longest_silence, ++scans.since_odometry);
}

void HeardOdometry::add(const std::string& topic, const RosTransform& odometry) {
  if (is_complete()) return;
  if (heard_.is_enough()) {
    scans_ = 0;
    heard_ = LookOver(look_over_s_);
    for (auto& [other, scans] : scans_without_) scans = {};
  }
  first_.emplace(topic, odometry);
  scans_without_[topic].since_odometry = 0;
}

bool HeardOdometry::is_silent(const std::string& topic) const {
  const auto scans = scans_without_.find(topic);
  return scans == scans_without_.end() || 2 * scans->second.longest_silence > scans_;
}

}  // namespace psi_slam
