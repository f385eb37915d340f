// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/bag_robots.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Topics of a bag that may be read. All are of one robot if the bag recorded several.
struct BagTopics {
  std::vector<std::string> scan_topics;
  bool chooses_lasers = false;  ///< whether the user selects none of several topics of scans
  std::vector<std::string> transform_topics;
  std::vector<std::string> odometry_topics;  ///< to choose from: one if the user names it
  bool expects_odometry = true;              ///< whether the user wants odometry and the bag may hold it
  std::vector<std::string> imu_topics;       ///< of gyroscopes to choose from
  std::string imu;                           ///< topic that the user names as log.imu, as in the bag
  std::vector<std::string> assumptions;      ///< see FrameSource::assumptions()
};

/// Chooses topics by their types and by the names that the user states. Scans are laser scans, or point
/// clouds if `options.slice_z_m` is set. Throws UserError if there are no scans, or if something that the
/// user names is missing. `path` names the bag in messages.
BagTopics choose_topics(const std::vector<BagTopic>& topics, const BagRobots& robots, const std::string& path,
                        const LogOptions& options);

/// Returns whether the messages of the topic are scans, or clouds if these are sliced.
bool has_scans(const BagTopic& topic, bool slices_clouds);

/// Returns whether the messages of the topic are transforms.
bool is_transforms(const BagTopic& topic);

/// Names by which users may state options of the laser of a topic.
std::vector<std::string> names_of_topic(const std::string& topic);

/// Returns the options for the laser of a topic, with its stated mount and delay.
LogOptions options_of_topic(const LogOptions& options, const std::string& topic);

/// Returns whether the user states the mount of the laser with the topic.
bool states_mount(const LogOptions& options, const std::string& topic);

}  // namespace psi_slam
