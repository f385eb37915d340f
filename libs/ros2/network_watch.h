// SPDX-License-Identifier: BSD-3-Clause
// Notices what goes wrong between a robot and psi-slam on the network, while mapping goes on.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "logs/rosbag/bag_plan.h"
#include "psi_slam/time_stamp.h"
#include "ros2/dds_inbox.h"

namespace psi_slam {

/// Returns whether a topic has laser scans or point clouds.
bool is_any_scan(const BagTopic& topic);

/// Facts about the network that the watch asks for when it needs them.
struct NetworkFacts {
  /// Returns a sentence about which publishers and domains there are.
  std::function<std::string()> describe;
  /// Returns the name of the node that has a publisher.
  std::function<std::string(std::uint64_t publisher)> node_of;
};

/// Prints a sentence when one of these faults begins, and again only after the fault had ended:
/// - no scan for five seconds; another sentence says when scans have resumed
/// - odometry that stops, or lags behind the scans
/// - two nodes that publish odometry, or the pose in the map
/// - a publisher that was restarted
/// - stamps that differ from the clock of this computer
class NetworkWatch {
 public:
  using Notify = std::function<void(const std::string&)>;

  NetworkWatch(NetworkFacts facts, std::string map_frame, Notify notify);

  /// Tells which topics and frames are read.
  void set_plan(const BagPlan& plan);

  /// Takes a message at `now_s` on a steady clock. `received_us`: time by the clock of this computer, empty
  /// if the robot's time is simulated.
  void take(const RosSample& sample, double now_s, std::optional<TimeUs> received_us);

  /// Call it several times a second.
  void pass_time(double now_s);

 private:
  struct Source {
    double last_s = 0;    ///< when its last message came
    TimeUs stamp_us = 0;  ///< stamp of its last message
    std::uint64_t publisher = 0;
  };

  struct Span {
    double first_s = 0;
    double last_s = 0;
  };

  bool is_scan(const BagTopic& topic) const;
  void take_scan(const RosSample& sample, double now_s, std::optional<TimeUs> received_us);
  void take_transforms(const RosSample& sample, double now_s);
  void take_odometry(const RosSample& sample, TimeUs stamp_us, double now_s);
  void compare_clocks(TimeUs stamp_us, TimeUs received_us);
  /// Prints a sentence if the fault was not present before. Returns whether it is present now.
  bool report(const std::string& fault, bool is_present, const std::function<std::string()>& sentence);

  NetworkFacts facts_;
  std::string map_frame_;
  Notify notify_;
  std::optional<BagPlan> plan_;
  std::optional<double> began_s_;    ///< time of the first call
  std::optional<double> planned_s_;  ///< time from which odometry is watched
  std::optional<Source> scan_;       ///< newest scan
  std::optional<Source> odometry_;
  std::map<std::string, Source> scans_;             ///< newest scan of each topic
  std::map<std::uint64_t, Span> odometry_heard_s_;  ///< when each publisher of odometry sent
  std::set<std::string> present_;                   ///< faults that were reported and have not ended
  int clock_differs_ = 0;  ///< number of scans in succession whose stamps differ from the clock
};

}  // namespace psi_slam
