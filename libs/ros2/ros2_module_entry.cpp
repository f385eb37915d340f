// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/log_player.h"
#include "ros2/ros2_node.h"

void psi_slam_open_ros2_link(const psi_slam::Ros2Options& options,
                             std::shared_ptr<psi_slam::Ros2Link>& link) {
  link = std::make_shared<psi_slam::Ros2Node>(options);
}

void psi_slam_open_ros2_player(const psi_slam::Ros2Options& options,
                               std::unique_ptr<psi_slam::Ros2Player>& player) {
  player = std::make_unique<psi_slam::LogPlayer>(options);
}
