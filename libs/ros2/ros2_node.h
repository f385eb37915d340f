// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "live/ros2_link.h"
#include "ros2/dds_inbox.h"
#include "ros2/map_publisher.h"
#include "ros2/network_bag.h"

namespace psi_slam {

/// psi-slam's node with Cyclone DDS.
class Ros2Node : public Ros2Link, public std::enable_shared_from_this<Ros2Node> {
 public:
  explicit Ros2Node(const Ros2Options& options);

  std::unique_ptr<BagFile> messages(const Ros2Reading& reading, const LiveControl& control) override;
  void set_plan(const BagPlan& plan) override;
  void pause(bool is_paused) override { is_paused_ = is_paused; }

  void publish_pose(const Ros2Pose& pose) override { publisher_.publish_pose(pose); }
  void publish_map(const mrpt::maps::COccupancyGridMap2D& map) override { publisher_.publish_map(map); }
  void publish_trajectory(const std::vector<std::pair<TimeUs, mrpt::math::TPose2D>>& map_T_robot) override {
    publisher_.publish_trajectory(map_T_robot);
  }
  void publish_constraints(const std::vector<Ros2Constraint>& constraints) override {
    publisher_.publish_constraints(constraints);
  }
  void publish_status(const Ros2Status& status) override { publisher_.publish_status(status); }

  std::optional<std::string> next_command() override;
  void answer(const std::string& sentence) override { publisher_.answer(sentence); }
  std::optional<mrpt::math::TPose2D> initial_pose() override;

 private:
  void take_requests();

  Ros2Options options_;
  DdsNode node_;
  RosClock clock_;
  MapPublisher publisher_;
  std::atomic<bool> is_paused_ = false;
  NetworkBag* bag_ = nullptr;  ///< the newest of messages(), which the caller owns

  std::mutex mutex_;  ///< protects the members below
  DdsInbox requests_;
  std::deque<std::string> commands_;
  std::optional<mrpt::math::TPose2D> initial_pose_;
};

}  // namespace psi_slam
