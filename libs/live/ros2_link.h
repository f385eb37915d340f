// SPDX-License-Identifier: BSD-3-Clause
// psi-slam as a node of ROS 2. This header knows no DDS: the module psi-slam-ros2.so implements the classes,
// and is loaded when ROS 2 is asked for.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "live/live_control.h"
#include "logs/rosbag/bag_plan.h"
#include "psi_slam/frame.h"
#include "psi_slam/loop_record.h"

namespace mrpt::maps {
class COccupancyGridMap2D;
}

namespace psi_slam {

/// Largest number of a domain. The ports of larger ones would exceed 65535.
inline constexpr std::uint32_t kMaximumRos2Domain = 232;

/// Name and place of a node in ROS 2.
struct Ros2Options {
  std::optional<std::uint32_t> domain;  ///< empty: ROS_DOMAIN_ID, or 0
  std::string name = "psi_slam";
  std::string name_space = "/";  ///< of the topics of this node, and of the robot's topics that are read
  /// Topics by the names that psi-slam gives them: "scan", "odom", "imu", "tf", "tf_static", "map", "pose",
  /// "trajectory", "initialpose" and so on. Those without an entry have the usual name in name_space.
  std::map<std::string, std::string> topics;
};

/// What is received from the robot.
struct Ros2Reading {
  bool reads_clouds = false;     ///< whether point clouds are read, which are large
  std::filesystem::path record;  ///< MCAP file that is written of all received messages; empty: none
  bool replaces_record = false;  ///< whether an existing file may be replaced
  std::optional<double> idle_s;  ///< ends the messages after this time without one; empty: never
};

/// Pose of the robot at a scan.
struct Ros2Pose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D map_T_robot;
  std::optional<mrpt::math::TPose2D> odom_T_robot;  ///< empty: the robot has no odometry
  std::optional<Eigen::Matrix3d> covariance;        ///< of (x, y, yaw) in the axes of the map; empty: unknown
};

/// A constraint of the graph between two places.
struct Ros2Constraint {
  mrpt::math::TPoint2D from, to;  ///< metres in the map
  std::optional<LoopState> loop;  ///< empty: a constraint of the path
};

/// State of the run, for /diagnostics.
struct Ros2Status {
  enum class Level : std::uint8_t { kGood = 0, kWarning = 1, kError = 2 };
  Level level = Level::kGood;
  std::string sentence;
  std::vector<std::pair<std::string, std::string>> values;  ///< names and values of what is measured
};

/// psi-slam's node. The functions may be called by several threads.
class Ros2Link {
 public:
  virtual ~Ros2Link() = default;

  /// Opens the robot's messages as a bag. Only one may be open.
  virtual std::unique_ptr<BagFile> messages(const Ros2Reading& reading, const LiveControl& control) = 0;
  /// Sets the topics and frames that are read. Poses are published only after this call.
  virtual void set_plan(const BagPlan& plan) = 0;
  /// Starts or stops dropping scans.
  virtual void pause(bool is_paused) = 0;

  /// Publishes the pose, and from now on the transform from the map to odometry at a steady rate.
  virtual void publish_pose(const Ros2Pose& pose) = 0;
  virtual void publish_map(const mrpt::maps::COccupancyGridMap2D& map) = 0;
  virtual void publish_trajectory(const std::vector<std::pair<TimeUs, mrpt::math::TPose2D>>& map_T_robot) = 0;
  virtual void publish_constraints(const std::vector<Ros2Constraint>& constraints) = 0;
  virtual void publish_status(const Ros2Status& status) = 0;

  /// Returns the next command of a user, without waiting.
  virtual std::optional<std::string> next_command() = 0;
  /// Publishes a sentence on ~/status.
  virtual void answer(const std::string& sentence) = 0;
  /// Returns the newest pose on /initialpose that was not returned before, in the map.
  virtual std::optional<mrpt::math::TPose2D> initial_pose() = 0;
};

/// Plays a log as a robot of ROS 2.
class Ros2Player {
 public:
  virtual ~Ros2Player() = default;
  /// Opens the topics of the lasers of a frame, and waits until a node receives all of them, at most
  /// `timeout_s`. Returns whether there is one.
  virtual bool wait_for_listener(const Frame& first, double timeout_s) = 0;
  /// Publishes the scans, the odometry and the clock of a frame. Throws UserError for scans that ROS cannot
  /// express, because their bearings are not evenly spaced.
  virtual void publish(const Frame& frame) = 0;
};

/// Opens a node. Throws UserError if the module is missing or the network cannot be used.
std::shared_ptr<Ros2Link> open_ros2_link(const Ros2Options& options);
std::unique_ptr<Ros2Player> open_ros2_player(const Ros2Options& options);

}  // namespace psi_slam

extern "C" {
/// What the functions above call in the module.
using PsiSlamOpenRos2Link = void(const psi_slam::Ros2Options& options,
                                 std::shared_ptr<psi_slam::Ros2Link>& link);
using PsiSlamOpenRos2Player = void(const psi_slam::Ros2Options& options,
                                   std::unique_ptr<psi_slam::Ros2Player>& player);
PsiSlamOpenRos2Link psi_slam_open_ros2_link;
PsiSlamOpenRos2Player psi_slam_open_ros2_player;
}
