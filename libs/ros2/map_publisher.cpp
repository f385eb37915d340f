// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/map_publisher.h"

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "logs/frames/pose_operations.h"
#include "map/rendering/map_image.h"
#include "ros2/message_views.h"
#include "ros2/ros_names.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;

const std::string kMapFrame = "map";
constexpr auto kTransformPeriod = std::chrono::milliseconds(50);
// Stamps the transform this far ahead, so that a lookup at the newest scan succeeds.
constexpr TimeUs kTolerance_us = 100'000;

constexpr double kWaitForMap_s = 10;  // a large map takes seconds on a wireless network
constexpr double kWaitAtEnd_s = 3;

constexpr std::int32_t kLineList = 5;  // visualization_msgs/Marker

std::vector<std::int8_t> cells_of(const COccupancyGridMap2D& map) {
  constexpr std::int8_t kUnknown = -1;
  constexpr std::int8_t kFree = 0;
  constexpr std::int8_t kOccupied = 100;
  const std::size_t width = map.getSizeX();
  std::vector<std::int8_t> cells(width * map.getSizeY());
  for (std::size_t y = 0; y < map.getSizeY(); ++y) {
    const auto* const row = map.getRow(static_cast<int>(y));
    std::transform(row, row + width, cells.begin() + static_cast<std::ptrdiff_t>(y * width), [](auto cell) {
      return is_occupied(cell) ? kOccupied : is_free(cell) ? kFree : kUnknown;
    });
  }
  return cells;
}

std_msgs_msg_dds__ColorRGBA_ colour_of(const std::optional<LoopState>& loop) {
  if (!loop) return {0.2F, 0.4F, 1.0F, 1.0F};
  return *loop == LoopState::kAccepted ? std_msgs_msg_dds__ColorRGBA_{0.1F, 0.8F, 0.2F, 1.0F}
                                       : std_msgs_msg_dds__ColorRGBA_{0.9F, 0.1F, 0.1F, 0.6F};
}

/// Returns both ends of each constraint that `belongs` selects.
template <class Belongs>
std::vector<geometry_msgs_msg_dds__Point_> ends_of(const std::vector<Ros2Constraint>& constraints,
                                                   Belongs belongs) {
  std::vector<geometry_msgs_msg_dds__Point_> ends;
  for (const Ros2Constraint& constraint : constraints) {
    if (!belongs(constraint)) continue;
    ends.push_back({constraint.from.x, constraint.from.y, 0});
    ends.push_back({constraint.to.x, constraint.to.y, 0});
  }
  return ends;
}

}  // namespace

MapPublisher::MapPublisher(DdsNode& node, const Ros2Options& names, const RosClock& clock)
    : clock_(clock),
      hardware_(names.name),
      transforms_(node.advertise<tf2_msgs_msg_dds__TFMessage_>(topic_of(names, "tf", "/tf"), {100, false})),
      poses_(node.advertise<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(
          topic_of(names, "pose", "pose"), {10, false})),
      maps_(node.advertise<nav_msgs_msg_dds__OccupancyGrid_>(topic_of(names, "map", "map"),
                                                             {1, true, kWaitForMap_s})),
      metadata_(node.advertise<nav_msgs_msg_dds__MapMetaData_>(
          topic_of(names, "map_metadata", "map_metadata"), {1, true})),
      trajectories_(
          node.advertise<nav_msgs_msg_dds__Path_>(topic_of(names, "trajectory", "trajectory"), {1, true})),
      markers_(node.advertise<visualization_msgs_msg_dds__MarkerArray_>(
          topic_of(names, "loops", names.name + "/loops"), {1, true})),
      diagnostics_(node.advertise<diagnostic_msgs_msg_dds__DiagnosticArray_>(
          topic_of(names, "diagnostics", "/diagnostics"), {10, false})),
      answers_(node.advertise<std_msgs_msg_dds__String_>(topic_of(names, "status", names.name + "/status"),
                                                         {10, true})),
      thread_([this] { work(); }) {}

MapPublisher::~MapPublisher() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
  maps_.wait_for_readers(kWaitAtEnd_s);
}

void MapPublisher::forget() {
  const std::lock_guard lock(mutex_);
  correction_.reset();
  child_frame_.clear();
}

void MapPublisher::set_plan(const BagPlan& plan) {
  const std::lock_guard lock(mutex_);
  child_frame_ = plan.has_odometry ? plan.odom_frame : plan.base_frame;
}

void MapPublisher::publish_pose(const Ros2Pose& pose) {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ message{};
  message.header = ros_header(pose.time_us, kMapFrame);
  message.pose.pose = ros_pose(pose.map_T_robot);
  if (pose.covariance) {
    constexpr int kAxes[3] = {0, 1, 5};  // x, y and yaw among ROS's six
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        message.pose.covariance[6 * kAxes[row] + kAxes[column]] = (*pose.covariance)(row, column);
  }
  poses_.write(message);
  const std::lock_guard lock(mutex_);
  const TPose2D robot_T_odom = inverse(pose.odom_T_robot.value_or(TPose2D()));
  correction_ =
      Correction{compose(pose.map_T_robot, robot_T_odom), pose.time_us, clock_.simulated_us, Clock::now()};
  send_transform();
}

/// Sends the transform, with the time by the robot's clock. The caller holds mutex_.
void MapPublisher::send_transform() {
  if (!correction_ || child_frame_.empty()) return;
  const TimeUs passed_us =
      correction_->simulated_us != 0
          ? std::max<TimeUs>(clock_.simulated_us - correction_->simulated_us, 0)
          : std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - correction_->came).count();
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms{ros_transform(
      kMapFrame, child_frame_, correction_->map_T_odom, correction_->scan_us + passed_us + kTolerance_us)};
  tf2_msgs_msg_dds__TFMessage_ message{};
  show(message.transforms, transforms);
  transforms_.write(message);
}

void MapPublisher::work() {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kTransformPeriod, [this] { return stop_; })) send_transform();
}

void MapPublisher::publish_map(const COccupancyGridMap2D& map) {
  std::vector<std::int8_t> cells = cells_of(map);
  nav_msgs_msg_dds__OccupancyGrid_ message{};
  message.header = ros_header(clock_.now_us(), kMapFrame);
  message.info.map_load_time = message.header.stamp;
  message.info.resolution = map.getResolution();
  message.info.width = static_cast<std::uint32_t>(map.getSizeX());
  message.info.height = static_cast<std::uint32_t>(map.getSizeY());
  message.info.origin = ros_pose({static_cast<double>(map.getXMin()), static_cast<double>(map.getYMin()), 0});
  show(message.data, cells);
  if (maps_.write(message)) metadata_.write(message.info);
}

void MapPublisher::publish_trajectory(const std::vector<std::pair<TimeUs, TPose2D>>& map_T_robot) {
  std::vector<geometry_msgs_msg_dds__PoseStamped_> poses;
  for (const auto& [time_us, pose] : map_T_robot)
    poses.push_back({ros_header(time_us, kMapFrame), ros_pose(pose)});
  nav_msgs_msg_dds__Path_ message{};
  message.header = ros_header(clock_.now_us(), kMapFrame);
  show(message.poses, poses);
  trajectories_.write(message);
}

void MapPublisher::publish_constraints(const std::vector<Ros2Constraint>& constraints) {
  static const std::string kNone;
  static const std::string kNamespaces[] = {"path", "accepted loops", "rejected loops"};
  const std::optional<LoopState> states[] = {std::nullopt, LoopState::kAccepted, LoopState::kRejected};
  std::vector<geometry_msgs_msg_dds__Point_> ends[3];
  std::vector<visualization_msgs_msg_dds__Marker_> markers(3);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    ends[i] =
        ends_of(constraints, [&](const Ros2Constraint& constraint) { return constraint.loop == states[i]; });
    visualization_msgs_msg_dds__Marker_& marker = markers[i];
    marker = {};
    marker.header = ros_header(clock_.now_us(), kMapFrame);
    marker.ns = dds_text(kNamespaces[i]);
    marker.type = kLineList;
    marker.pose = ros_pose({});
    marker.scale.x = 0.05;  // width of a line, metres
    marker.color = colour_of(states[i]);
    show(marker.points, ends[i]);
    for (char** const text :
         {&marker.texture_resource, &marker.texture.header.frame_id, &marker.texture.format, &marker.text,
          &marker.mesh_resource, &marker.mesh_file.filename})
      *text = dds_text(kNone);
  }
  visualization_msgs_msg_dds__MarkerArray_ message{};
  show(message.markers, markers);
  markers_.write(message);
}

void MapPublisher::publish_status(const Ros2Status& status) {
  std::vector<diagnostic_msgs_msg_dds__KeyValue_> values;
  for (const auto& [key, value] : status.values) values.push_back({dds_text(key), dds_text(value)});
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> all(1);
  all[0] = {static_cast<std::uint8_t>(status.level),
            dds_text(hardware_),
            dds_text(status.sentence),
            dds_text(hardware_),
            {}};
  show(all[0].values, values);
  diagnostic_msgs_msg_dds__DiagnosticArray_ message{};
  static const std::string kNoFrame;
  message.header = ros_header(clock_.now_us(), kNoFrame);
  show(message.status, all);
  diagnostics_.write(message);
}

void MapPublisher::answer(const std::string& sentence) {
  answers_.write({dds_text(sentence)});
}

}  // namespace psi_slam
