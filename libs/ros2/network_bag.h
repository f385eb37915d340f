// SPDX-License-Identifier: BSD-3-Clause
// The messages of a robot on the network, as a bag that is still being recorded.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/failure_notice.h"
#include "live/live_control.h"
#include "live/ros2_link.h"
#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/mcap_writer.h"
#include "ros2/dds_inbox.h"
#include "ros2/network_watch.h"

namespace psi_slam {

/// The robot's time.
struct RosClock {
  std::atomic<TimeUs> simulated_us = 0;  ///< newest message on /clock; 0: none came

  /// Time by /clock if the robot's time is simulated, otherwise by this computer.
  TimeUs now_us() const;
  bool is_simulated() const { return simulated_us != 0; }
};

/// Subscribes to scans, odometry, transforms and IMUs as publishers of them appear. Ends when the user stops
/// it or nothing came for Ros2Reading::idle_s.
class NetworkBag : public BagFile {
 public:
  /// `owner` keeps `node`, `clock` and `is_paused` alive.
  NetworkBag(std::shared_ptr<const void> owner, DdsNode& node, const Ros2Options& names,
             const Ros2Reading& reading, const LiveControl& control, RosClock& clock,
             const std::atomic<bool>& is_paused);

  /// Tells the watch which topics and frames are read. Called by the thread that reads.
  void set_plan(const BagPlan& plan) { watch_.set_plan(plan); }

  void want(const std::vector<std::string>& topics) override;
  bool next(BagMessage& message) override;
  std::string place() const override;

  std::vector<BagTopic> topics() override;  ///< throws std::logic_error: unknown before the end
  double progress() const override { return 0; }

 private:
  void subscribe_to_new_topics();
  void subscribe(const RosPublisher& publisher);
  bool is_of_robot(const RosPublisher& publisher) const;
  bool is_needed(const RosPublisher& publisher) const;
  bool receive();
  void take_clock(const RosSample& sample);
  void record(const BagMessage& message);
  void end_recording();
  std::string describe_network() const;

  const std::shared_ptr<const void> owner_;
  DdsNode& node_;
  DdsInbox inbox_;
  const Ros2Options names_;
  const Ros2Reading reading_;
  const LiveControl control_;
  RosClock& clock_;
  const std::atomic<bool>& is_paused_;
  NetworkWatch watch_;
  std::unique_ptr<McapWriter> recorder_;
  FailureNotice recorder_notice_{"the recording"};
  std::deque<RosSample> waiting_;
  RosSample current_;
  std::uint64_t messages_ = 0;     ///< number of messages that were returned
  bool has_lost_ = false;          ///< whether the user knows of lost messages
  std::set<std::string> refused_;  ///< topics that cannot be read
  bool is_prompt_ = true;          ///< whether messages are read soon after they came
  double last_take_s_ = 0;         ///< on a steady clock
  double last_message_s_ = 0;      ///< on a steady clock
  double last_discovery_s_ = 0;    ///< on a steady clock
};

}  // namespace psi_slam
