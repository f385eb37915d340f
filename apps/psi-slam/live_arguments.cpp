// SPDX-License-Identifier: BSD-3-Clause
#include "live_arguments.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/text_parts.h"
#include "document_options.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

double seconds_of(const std::string& option, const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value || *value < 0) throw UserError(option + " " + text + ": expected seconds, 0 or more");
  return *value;
}

std::uint16_t port_of(const std::string& text) {
  const auto port = parse_whole_number(text, std::numeric_limits<std::uint16_t>::max());
  if (!port)
    throw UserError("--tcp " + text +
                    ": expected the number of a port, 0 to 65535. With 0 the system chooses one");
  return static_cast<std::uint16_t>(*port);
}

std::uint32_t domain_of(const std::string& text) {
  const auto domain = parse_whole_number(text, kMaximumRos2Domain);
  if (!domain)
    throw UserError("--domain " + text +
                    ": expected a whole number from 0 to 232. Use the ROS_DOMAIN_ID of the robot");
  return *domain;
}

std::string name_space_of(std::string text) {
  if (text.front() != '/') text.insert(0, 1, '/');
  if (text.size() > 1 && text.back() == '/') text.pop_back();
  const bool is_valid =
      text.find("//") == std::string::npos &&
      text.find_first_not_of("/_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") ==
          std::string::npos;
  if (!is_valid)
    throw UserError("--namespace " + text + ": expected letters, digits, _ and /, such as /robot1");
  return text;
}

/// Parses "NAME=TOPIC".
std::pair<std::string, std::string> renamed_topic(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size())
    throw UserError("--topic " + text + ": expected NAME=TOPIC, such as scan=/robot1/front_scan");
  const std::string name = text.substr(0, equals);
  const std::vector<std::string> names{"scan",   "odom",         "imu",         "tf",         "tf_static",
                                       "map",    "map_metadata", "pose",        "trajectory", "loops",
                                       "status", "command",      "initialpose", "diagnostics"};
  // A player has further lasers: scan_1, scan_2 and so on.
  const bool is_known =
      std::find(names.begin(), names.end(), name) != names.end() || name.rfind("scan_", 0) == 0;
  if (!is_known)
    throw UserError("--topic " + text + ": there is no topic \"" + name + "\", expected one of " +
                    name_list(names));
  return {name, text.substr(equals + 1)};
}

}  // namespace

void add_ros2_options(CLI::App& command, Ros2Arguments& arguments, const std::string& help) {
  command.add_flag("--ros2", arguments.is_given, help);
  add_value(command, "--domain", arguments.domain, "Domain of ROS 2, 0 to 232. Default: ROS_DOMAIN_ID, or 0",
            "N");
  add_value(command, "--namespace", arguments.name_space,
            "Read topics in this namespace only, and publish in it, such as /robot1. Default: all topics",
            "NAME");
  command
      .add_option(
          "--topic", arguments.topics,
          "Read or publish another topic: NAME is scan, odom, imu, tf, tf_static, map, map_metadata, pose, "
          "trajectory, loops, status, command, initialpose or diagnostics. May be repeated")
      ->type_name("NAME=TOPIC")
      ->allow_extra_args(false);
}

Ros2Options ros2_options(const Ros2Arguments& arguments, const std::string& node_name) {
  if (!arguments.is_given) {
    const auto refuse = [](const char* option, bool given) {
      if (given)
        throw UserError(std::string(option) + " has no effect without --ros2. Add --ros2, or leave it out");
    };
    refuse("--domain", !arguments.domain.empty());
    refuse("--namespace", !arguments.name_space.empty());
    refuse("--topic", !arguments.topics.empty());
  }
  Ros2Options options;
  options.name = node_name;
  if (!arguments.domain.empty()) options.domain = domain_of(arguments.domain);
  if (!arguments.name_space.empty()) options.name_space = name_space_of(arguments.name_space);
  for (const std::string& topic : arguments.topics) options.topics.insert(renamed_topic(topic));
  return options;
}

void add_source_options(CLI::App& command, LiveArguments& arguments) {
  add_value(command, "--tcp", arguments.tcp, "Read CARMEN lines that a client sends to this TCP port",
            "PORT");
  add_value(command, "--bind", arguments.address,
            "Address of this computer to listen on with --tcp. Default: 127.0.0.1, which only this computer "
            "reaches",
            "ADDRESS");
  add_value(command, "--follow", arguments.follow,
            "Read a log or bag that is still being recorded: a file, or the folder of a ROS 2 bag", "LOG");
  add_value(
      command, "--sensors", arguments.sensors,
      "Read sensors by the drivers of MRPT, with the settings that rawlog-grabber and icp-slam-live use",
      "INI");
  add_ros2_options(command, arguments.ros2,
                   "Read the topics of a ROS 2 robot: scans, transforms, odometry, IMU");
  add_value(command, "--record", arguments.record,
            "Record the messages that --ros2 receives in this bag, which psi-slam and ros2 bag play read",
            "MCAP");
  add_value(command, "--idle-s", arguments.idle_s,
            "End after so many seconds without data. Default: end with the data or by Ctrl-C", "SECONDS");
  add_value(
      command, "--look-over-s", arguments.look_over_s,
      "Choose lasers, odometry and the mask of the robot's body by the first seconds of scans. Default: 5",
      "SECONDS");
}

void add_live_options(CLI::App& command, LiveArguments& arguments) {
  command.add_flag("--stdin", arguments.standard_input, "Read CARMEN lines from standard input");
  add_source_options(command, arguments);
  add_value(command, "--poses", arguments.poses,
            "Print the pose of each scan to standard output, one line each: tum or json", "FORMAT");
}

std::optional<LiveInput> live_input(const LiveArguments& arguments) {
  const int sources = (arguments.standard_input ? 1 : 0) + (arguments.tcp.empty() ? 0 : 1) +
                      (arguments.follow.empty() ? 0 : 1) + (arguments.sensors.empty() ? 0 : 1) +
                      (arguments.ros2.is_given ? 1 : 0);
  if (sources > 1) throw UserError("name only one source, such as --ros2 or --follow LOG");
  const Ros2Options ros2 = ros2_options(arguments.ros2, "psi_slam");
  if (!arguments.record.empty() && !arguments.ros2.is_given)
    throw UserError("--record has no effect without --ros2. Add --ros2, or leave it out");
  if (!arguments.address.empty() && arguments.tcp.empty())
    throw UserError("--bind has no effect without --tcp PORT");
  if (sources == 0) {
    const auto refuse = [](const char* option, const std::string& value) {
      if (!value.empty())
        throw UserError(std::string(option) + " needs a live source, such as --ros2 or --follow LOG");
    };
    refuse("--idle-s", arguments.idle_s);
    refuse("--look-over-s", arguments.look_over_s);
    refuse("--poses", arguments.poses);
    return std::nullopt;
  }
  LiveInput input;
  if (!arguments.tcp.empty()) {
    input.kind = LiveInput::Kind::kTcp;
    input.port = port_of(arguments.tcp);
    if (!arguments.address.empty()) input.address = arguments.address;
  } else if (!arguments.follow.empty()) {
    input.kind = LiveInput::Kind::kFollow;
    input.file = arguments.follow;
  } else if (!arguments.sensors.empty()) {
    input.kind = LiveInput::Kind::kSensors;
    input.file = arguments.sensors;
  } else if (arguments.ros2.is_given) {
    input.kind = LiveInput::Kind::kRos2;
    input.ros2 = ros2;
    input.record = arguments.record;
  }
  if (!arguments.idle_s.empty()) input.idle_s = seconds_of("--idle-s", arguments.idle_s);
  if (!arguments.look_over_s.empty()) input.look_over_s = seconds_of("--look-over-s", arguments.look_over_s);
  return input;
}

std::optional<PoseFormat> pose_format(const LiveArguments& arguments) {
  if (arguments.poses.empty()) return std::nullopt;
  if (arguments.poses == "tum") return PoseFormat::kTum;
  if (arguments.poses == "json") return PoseFormat::kJson;
  throw UserError("--poses " + arguments.poses + ": expected tum or json");
}

}  // namespace psi_slam
