// SPDX-License-Identifier: BSD-3-Clause
#include "live/ros2_link.h"

#include "live/loaded_module.h"

namespace psi_slam {
namespace {

template <class Function>
Function* function_of_ros2(const char* name) {
  return reinterpret_cast<Function*>(function_of_module(
      "psi-slam-ros2.so", name, "the connection to ROS 2",
      "Install psi-slam and Cyclone DDS (libddsc0) again, or build psi-slam with -DPSI_SLAM_ROS2=ON"));
}

}  // namespace

std::shared_ptr<Ros2Link> open_ros2_link(const Ros2Options& options) {
  static auto* const open = function_of_ros2<PsiSlamOpenRos2Link>("psi_slam_open_ros2_link");
  std::shared_ptr<Ros2Link> link;
  open(options, link);
  return link;
}

std::unique_ptr<Ros2Player> open_ros2_player(const Ros2Options& options) {
  static auto* const open = function_of_ros2<PsiSlamOpenRos2Player>("psi_slam_open_ros2_player");
  std::unique_ptr<Ros2Player> player;
  open(options, player);
  return player;
}

}  // namespace psi_slam
