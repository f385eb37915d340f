// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/ros2_node.h"

#include <utility>

#include "base/byte_cursor.h"
#include "logs/rosbag/ros_messages.h"
#include "ros2/ros_names.h"

namespace psi_slam {
namespace {

const std::string kString = "std_msgs/String";

}  // namespace

Ros2Node::Ros2Node(const Ros2Options& options)
    : options_(options),
      node_(dds_network(options.domain), options.name, options.name_space),
      publisher_(node_, options, clock_),
      requests_(node_) {
  requests_.subscribe(topic_of(options_, "command", options_.name + "/command"), kString,
                      RosReading::kReliable);
  requests_.subscribe(topic_of(options_, "initialpose", "initialpose"),
                      "geometry_msgs/PoseWithCovarianceStamped", RosReading::kReliable);
}

std::unique_ptr<BagFile> Ros2Node::messages(const Ros2Reading& reading, const LiveControl& control) {
  publisher_.forget();
  is_paused_ = false;
  auto bag =
      std::make_unique<NetworkBag>(shared_from_this(), node_, options_, reading, control, clock_, is_paused_);
  bag_ = bag.get();
  return bag;
}

void Ros2Node::set_plan(const BagPlan& plan) {
  publisher_.set_plan(plan);
  bag_->set_plan(plan);
}

/// Takes the messages that have come for psi-slam itself. The caller holds mutex_.
void Ros2Node::take_requests() {
  std::deque<RosSample> samples;
  requests_.take(samples, 0);
  for (const RosSample& sample : samples) {
    const BagMessage message{&sample.topic, 0, sample.bytes};
    try {
      if (sample.topic.type == kString)
        commands_.push_back(read_ros_string(message));
      else if (const std::string frame = read_ros_header(message).frame; frame != "map")
        publisher_.answer("initialpose: the pose is in the frame \"" + frame +
                          "\", expected \"map\". Set the fixed frame of RViz to map");
      else if (const auto pose = read_ros_pose(message))
        initial_pose_ = *pose;
    } catch (const MalformedBytes&) {
      publisher_.answer("a message on " + sample.topic.name + " is damaged. Send it again");
    }
  }
}

std::optional<std::string> Ros2Node::next_command() {
  const std::lock_guard lock(mutex_);
  take_requests();
  if (commands_.empty()) return std::nullopt;
  std::string command = std::move(commands_.front());
  commands_.pop_front();
  return command;
}

std::optional<mrpt::math::TPose2D> Ros2Node::initial_pose() {
  const std::lock_guard lock(mutex_);
  take_requests();
  return std::exchange(initial_pose_, std::nullopt);
}

}  // namespace psi_slam
