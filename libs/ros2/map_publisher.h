// SPDX-License-Identifier: BSD-3-Clause
// Publishes map, pose, path, loops and state of a run.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "live/ros2_link.h"
#include "ros2/dds_node.h"
#include "ros2/network_bag.h"

namespace psi_slam {

/// | topic | type | when |
/// | --- | --- | --- |
/// | /tf | the transform from map to odometry | after each scan, and 20 times a second |
/// | /pose | PoseWithCovarianceStamped | after each scan |
/// | /map, /map_metadata | OccupancyGrid, MapMetaData, latched | when the map has changed |
/// | /trajectory | Path, latched | every 5 s while mapping keeps up |
/// | ~/loops | MarkerArray, latched | every 5 s while mapping keeps up |
/// | /diagnostics | DiagnosticArray | once a second |
/// | ~/status | String, latched | answers to commands |
class MapPublisher {
 public:
  MapPublisher(DdsNode& node, const Ros2Options& names, const RosClock& clock);
  ~MapPublisher();

  /// Publishes no transform until the next plan and pose.
  void forget();
  void set_plan(const BagPlan& plan);
  void publish_pose(const Ros2Pose& pose);
  void publish_map(const mrpt::maps::COccupancyGridMap2D& map);
  void publish_trajectory(const std::vector<std::pair<TimeUs, mrpt::math::TPose2D>>& map_T_robot);
  void publish_constraints(const std::vector<Ros2Constraint>& constraints);
  void publish_status(const Ros2Status& status);
  void answer(const std::string& sentence);

 private:
  using Clock = std::chrono::steady_clock;

  /// The transform that is published until the next scan.
  struct Correction {
    mrpt::math::TPose2D map_T_odom;
    TimeUs scan_us = 0;       ///< stamp of the newest scan
    TimeUs simulated_us = 0;  ///< the robot's simulated time when it came; 0: not simulated
    Clock::time_point came;
  };

  void work();
  void send_transform();

  const RosClock& clock_;
  const std::string hardware_;
  RosWriter<tf2_msgs_msg_dds__TFMessage_> transforms_;
  RosWriter<geometry_msgs_msg_dds__PoseWithCovarianceStamped_> poses_;
  RosWriter<nav_msgs_msg_dds__OccupancyGrid_> maps_;
  RosWriter<nav_msgs_msg_dds__MapMetaData_> metadata_;
  RosWriter<nav_msgs_msg_dds__Path_> trajectories_;
  RosWriter<visualization_msgs_msg_dds__MarkerArray_> markers_;
  RosWriter<diagnostic_msgs_msg_dds__DiagnosticArray_> diagnostics_;
  RosWriter<std_msgs_msg_dds__String_> answers_;

  std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::string child_frame_;  ///< of the transform: that of odometry, or the robot's; empty: not known yet
  std::optional<Correction> correction_;
  bool stop_ = false;

  std::thread thread_;
};

}  // namespace psi_slam
