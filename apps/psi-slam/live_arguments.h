// SPDX-License-Identifier: BSD-3-Clause
// Options of the commands that read a driving robot instead of a log.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "live/live_source.h"
#include "pose_lines.h"

namespace psi_slam {

/// Options of a node of ROS 2.
struct Ros2Arguments {
  bool is_given = false;  ///< --ros2
  std::string domain;     ///< number
  std::string name_space;
  std::vector<std::string> topics;  ///< "NAME=TOPIC"
};

/// The options before their values are examined; empty texts were not given.
struct LiveArguments {
  bool standard_input = false;
  std::string tcp;      ///< number of the port
  std::string address;  ///< --bind
  std::string follow;   ///< log that grows
  std::string sensors;  ///< settings file of rawlog-grabber
  Ros2Arguments ros2;
  std::string record;       ///< MCAP file
  std::string idle_s;       ///< seconds
  std::string look_over_s;  ///< seconds
  std::string poses;        ///< "tum" or "json"
};

/// Adds the options of a source that fill `arguments`, except standard input.
void add_source_options(CLI::App& command, LiveArguments& arguments);

/// Adds --ros2 and the options of its node. `help`: what --ros2 does.
void add_ros2_options(CLI::App& command, Ros2Arguments& arguments, const std::string& help);

/// Returns the node that the options describe. Throws UserError for invalid values, and for options without
/// --ros2.
Ros2Options ros2_options(const Ros2Arguments& arguments, const std::string& node_name);

/// Adds all options that fill `arguments`.
void add_live_options(CLI::App& command, LiveArguments& arguments);

/// Returns the source that the options name; empty if they name none. Throws UserError if they name several
/// sources, if a value is invalid, or if an option has no effect.
std::optional<LiveInput> live_input(const LiveArguments& arguments);

/// Returns the form of the lines of poses; empty for none. Throws UserError for an unknown form.
std::optional<PoseFormat> pose_format(const LiveArguments& arguments);

}  // namespace psi_slam
