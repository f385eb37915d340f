// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/bag_robots.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "logs/frames/laser_choice.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/ros_messages.h"

namespace psi_slam {
namespace {

using Names = std::vector<std::string>;

/// First word of a topic of several words, such as "robot1" of "/robot1/scan"; empty for "/scan".
std::string namespace_of(const std::string& topic) {
  const std::size_t begin = topic.empty() || topic.front() != '/' ? 0 : 1;
  const std::size_t end = topic.find('/', begin);
  return end == std::string::npos ? "" : topic.substr(begin, end - begin);
}

bool is_scan_topic(const BagTopic& topic) {
  return topic.type == kRosLaserScan || topic.type == kRosMultiEchoScan || topic.type == kRosPointCloud;
}

}  // namespace

BagRobots::BagRobots(const std::vector<BagTopic>& topics) {
  const auto has = [&](const std::string& name, const auto& is_kind) {
    return std::any_of(topics.begin(), topics.end(), [&](const BagTopic& topic) {
      return namespace_of(topic.name) == name && is_kind(topic);
    });
  };
  for (const BagTopic& topic : topics) {
    const std::string name = namespace_of(topic.name);
    const bool moves = has(name, [](const BagTopic& one) {
      return one.type == kRosOdometry || (is_transforms(one) && !namespace_of(one.name).empty());
    });
    if (is_scan_topic(topic) && moves && !contains(names_, name)) names_.push_back(name);
  }
}

bool BagRobots::has_robot(const std::string& topic) const {
  return contains(names_, namespace_of(topic));
}

std::string BagRobots::robot_of(const std::string& topic) const {
  return has_robot(topic) ? namespace_of(topic) : "";
}

bool BagRobots::may_share(const std::string& topic, const std::string& scan_topic) const {
  return !are_several() || robot_of(topic).empty() || robot_of(topic) == robot_of(scan_topic);
}

Names BagRobots::of_robot(const Names& topics, const std::string& scan_topic) const {
  const bool has_own = std::any_of(topics.begin(), topics.end(), [&](const std::string& topic) {
    return robot_of(topic) == robot_of(scan_topic);
  });
  const bool are_others = are_several() && has_own && contains(names_, "");
  Names found;
  for (const std::string& topic : topics)
    if (are_others ? robot_of(topic) == robot_of(scan_topic) : may_share(topic, scan_topic))
      found.push_back(topic);
  return found;
}

bool is_named_like_odometry(std::string frame) {
  return has_word(std::move(frame), "odom");
}

std::string base_frame_by_name(const TransformTree& transforms, const Names& laser_frames) {
  if (laser_frames.empty()) return {};
  for (const std::string& laser : laser_frames) {
    const Names way = transforms.way_up(laser);
    const auto base = std::find_if(way.rbegin(), way.rend(),
                                   [](const std::string& frame) { return has_word(frame, "base"); });
    if (base != way.rend()) return *base;
  }
  const Names way = transforms.way_up(laser_frames.front());
  const auto common = std::find_if(way.begin(), way.end(), [&](const std::string& frame) {
    return std::all_of(laser_frames.begin(), laser_frames.end(),
                       [&](const std::string& laser) { return contains(transforms.way_up(laser), frame); });
  });
  return common == way.end() ? way.front() : *common;
}

bool are_on_one_robot(const TransformTree& transforms, const std::string& a, const std::string& b) {
  const Names above_a = transforms.way_up(a);
  const Names above_b = transforms.way_up(b);
  const auto meeting = std::find_first_of(above_a.begin(), above_a.end(), above_b.begin(), above_b.end());
  if (meeting == above_a.end()) return false;
  const auto leaves_robot = [&](const Names& way) {
    const auto end = std::next(std::find(way.begin(), way.end(), *meeting));
    return std::any_of(std::next(way.begin()), end, [](const std::string& frame) {
      return has_word(frame, "odom") || has_word(frame, "map") || has_word(frame, "world");
    });
  };
  return !leaves_robot(above_a) && !leaves_robot(above_b);
}

}  // namespace psi_slam
