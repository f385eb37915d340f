// SPDX-License-Identifier: BSD-3-Clause
// Names of topics as ROS 2 resolves them.
#pragma once

#include <string>

#include "base/text_parts.h"
#include "live/ros2_link.h"

namespace psi_slam {

/// Returns whether a topic is in a namespace: "/robot1/scan" in "/robot1", and every topic in "/".
inline bool is_in_namespace(const std::string& topic, const std::string& name_space) {
  return name_space == "/" || starts_with(topic, name_space + "/");
}

/// Returns `name` in a namespace: "/map" or "/robot1/map". A name that begins with a slash stays.
inline std::string in_namespace(const std::string& name, const std::string& name_space) {
  if (starts_with(name, "/")) return name;
  return (name_space == "/" ? "/" : name_space + "/") + name;
}

/// Returns the topic that psi-slam publishes or receives for one of its names, such as "map": the first that
/// the user states, or else `usual`. Both are relative to the namespace unless they begin with a slash.
inline std::string topic_of(const Ros2Options& names, const std::string& name, const std::string& usual) {
  const auto stated = names.topics.find(name);
  const std::string topics = stated == names.topics.end() ? usual : stated->second;
  return in_namespace(topics.substr(0, topics.find(',')), names.name_space);
}

}  // namespace psi_slam
