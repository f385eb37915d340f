// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "live/ros2_link.h"
#include "ros2/dds_node.h"

namespace psi_slam {

/// Publishes the frames of a log as a robot does: scans of the first laser on /scan, of others on /scan_1,
/// /scan_2 and so on; odometry as nav_msgs/Odometry and as the transform from odom to base_link; the mounts
/// of the lasers on /tf_static; and the time on /clock.
class LogPlayer : public Ros2Player {
 public:
  explicit LogPlayer(const Ros2Options& names);

  bool wait_for_listener(const Frame& first, double timeout_s) override;
  void publish(const Frame& frame) override;

 private:
  struct Laser {
    RosWriter<sensor_msgs_msg_dds__LaserScan_> writer;
    std::string frame;
    std::optional<mrpt::math::TPose2D> mount;  ///< as it was published; empty: not yet
  };

  Laser& laser_of(std::size_t number);
  void publish_scan(const LaserScan& scan, TimeUs time_us);
  void publish_mounts(const Frame& frame);
  void publish_odometry(const mrpt::math::TPose2D& odom_T_robot, TimeUs time_us);

  Ros2Options names_;
  DdsNode node_;
  RosWriter<rosgraph_msgs_msg_dds__Clock_> clock_;
  RosWriter<tf2_msgs_msg_dds__TFMessage_> transforms_;
  RosWriter<tf2_msgs_msg_dds__TFMessage_> mounts_;
  RosWriter<nav_msgs_msg_dds__Odometry_> odometry_;
  std::map<std::size_t, Laser> lasers_;  ///< by LaserScan::laser
};

}  // namespace psi_slam
