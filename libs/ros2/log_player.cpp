// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/log_player.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"
#include "ros2/message_views.h"
#include "ros2/ros_names.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

const std::string kOdomFrame = "odom";
const std::string kBaseFrame = "base_link";

// Depth of the queue for slow readers.
constexpr RosQuality kSensor{2000, false};
constexpr RosQuality kLatched{1, true};

/// Angle between neighbouring beams. Throws UserError if the bearings are not evenly spaced.
double step_of(const std::vector<float>& bearings_rad) {
  constexpr double kTolerance_rad = 1e-4;
  if (bearings_rad.size() < 2) return 0;
  const auto bearing = [&](std::size_t i) { return static_cast<double>(bearings_rad[i]); };
  const std::size_t last = bearings_rad.size() - 1;
  const double step_rad = (bearing(last) - bearing(0)) / static_cast<double>(last);
  for (std::size_t i = 0; i <= last; ++i)
    if (std::abs(bearing(0) + step_rad * static_cast<double>(i) - bearing(i)) > kTolerance_rad)
      throw UserError(
          "the bearings of the laser are not evenly spaced, but sensor_msgs/LaserScan needs that. Choose "
          "another "
          "laser with log.laser");
  const auto even = bearings_of_whole_degrees(bearings_rad.front(), step_rad, bearings_rad.size());
  if (even && even->bearings_rad == bearings_rad)
    return even->step_rad;  // a mean of rounded bearings differs
  return step_rad;
}

}  // namespace

LogPlayer::LogPlayer(const Ros2Options& names)
    : names_(names),
      node_(dds_network(names.domain), names.name, names.name_space),
      clock_(node_.advertise<rosgraph_msgs_msg_dds__Clock_>("/clock", kSensor)),
      transforms_(node_.advertise<tf2_msgs_msg_dds__TFMessage_>(topic_of(names, "tf", "/tf"), kSensor)),
      mounts_(node_.advertise<tf2_msgs_msg_dds__TFMessage_>(topic_of(names, "tf_static", "/tf_static"),
                                                            kLatched)),
      odometry_(node_.advertise<nav_msgs_msg_dds__Odometry_>(topic_of(names, "odom", "odom"), kSensor)) {}

LogPlayer::Laser& LogPlayer::laser_of(std::size_t number) {
  const auto found = lasers_.find(number);
  if (found != lasers_.end()) return found->second;
  const std::string suffix = number == 0 ? "" : "_" + std::to_string(number);
  return lasers_
      .emplace(number, Laser{node_.advertise<sensor_msgs_msg_dds__LaserScan_>(
                                 topic_of(names_, "scan" + suffix, "scan" + suffix), kSensor),
                             "laser" + suffix, std::nullopt})
      .first->second;
}

bool LogPlayer::wait_for_listener(const Frame& first, double timeout_s) {
  laser_of(first.scan.laser);
  for (const CompanionScan& companion : first.companions) laser_of(companion.scan.laser);
  const auto is_heard = [](const auto& laser) { return laser.second.writer.readers() > 0; };
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!std::all_of(lasers_.begin(), lasers_.end(), is_heard)) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

void LogPlayer::publish(const Frame& frame) {
  clock_.write({ros_time(frame.time_us)});
  publish_mounts(frame);
  if (frame.has_odometry) publish_odometry(frame.odom_T_robot, frame.time_us);
  publish_scan(frame.scan, frame.time_us);
  for (const CompanionScan& companion : frame.companions) {
    if (frame.has_odometry)
      publish_odometry(compose(frame.odom_T_robot, companion.frame_T_robot), companion.time_us);
    publish_scan(companion.scan, companion.time_us);
  }
}

/// Publishes the mounts of all lasers if one of them is new or has changed.
void LogPlayer::publish_mounts(const Frame& frame) {
  bool is_new = false;
  const auto take = [&](const LaserScan& scan) {
    Laser& laser = laser_of(scan.laser);
    is_new = is_new || !laser.mount || *laser.mount != scan.robot_T_laser;
    laser.mount = scan.robot_T_laser;
  };
  take(frame.scan);
  for (const CompanionScan& companion : frame.companions) take(companion.scan);
  if (!is_new) return;
  std::vector<geometry_msgs_msg_dds__TransformStamped_> mounts;
  for (const auto& [number, laser] : lasers_)
    if (laser.mount) mounts.push_back(ros_transform(kBaseFrame, laser.frame, *laser.mount, frame.time_us));
  tf2_msgs_msg_dds__TFMessage_ message{};
  show(message.transforms, mounts);
  mounts_.write(message);
}

void LogPlayer::publish_odometry(const TPose2D& odom_T_robot, TimeUs time_us) {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms{
      ros_transform(kOdomFrame, kBaseFrame, odom_T_robot, time_us)};
  tf2_msgs_msg_dds__TFMessage_ of_robot{};
  show(of_robot.transforms, transforms);
  transforms_.write(of_robot);
  nav_msgs_msg_dds__Odometry_ message{};
  message.header = ros_header(time_us, kOdomFrame);
  message.child_frame_id = dds_text(kBaseFrame);
  message.pose.pose = ros_pose(odom_T_robot);
  odometry_.write(message);
}

void LogPlayer::publish_scan(const LaserScan& scan, TimeUs time_us) {
  const Laser& laser = laser_of(scan.laser);
  const std::vector<float>& bearings_rad = *scan.bearings_rad;
  std::vector<float> ranges_m = scan.ranges_m;
  const double step_rad = step_of(bearings_rad);
  sensor_msgs_msg_dds__LaserScan_ message{};
  message.header = ros_header(time_us, laser.frame);
  if (!bearings_rad.empty()) {
    message.angle_min = bearings_rad.front();
    message.angle_max = bearings_rad.back();
    message.angle_increment = static_cast<float>(step_rad);
    message.time_increment =
        scan.sweep_time_s / static_cast<float>(std::max<std::size_t>(bearings_rad.size() - 1, 1));
  }
  message.range_max = scan.max_range_m;
  show(message.ranges, ranges_m);
  laser.writer.write(message);
}

}  // namespace psi_slam
