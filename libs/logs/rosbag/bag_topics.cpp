// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/bag_topics.h"

#include <algorithm>
#include <utility>

#include "base/text_parts.h"
#include "logs/frames/gyroscope_choice.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_reader.h"
#include "logs/rosbag/ros_messages.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Names = std::vector<std::string>;

Names topics_of_type(const std::vector<BagTopic>& topics, const char* type) {
  Names names;
  for (const BagTopic& topic : topics)
    if (topic.type == type && topic.encoding != BagEncoding::kOther) names.push_back(topic.name);
  return names;
}

/// Returns the name of a topic as in the bag: users, and some programs that record bags, omit the leading
/// slash.
std::string as_in_bag(const std::string& name, const Names& all) {
  if (contains(all, '/' + name)) return '/' + name;
  const bool has_slash = !name.empty() && name.front() == '/';
  return has_slash && contains(all, name.substr(1)) ? name.substr(1) : name;
}

class TopicChooser {
 public:
  TopicChooser(const std::vector<BagTopic>& topics, const BagRobots& robots, std::string path,
               const LogOptions& options)
      : topics_(topics),
        robots_(robots),
        path_(std::move(path)),
        options_(options),
        slices_clouds_(height_slice(options).has_value()) {}

  BagTopics choose() {
    choose_scan_topics();
    for (const BagTopic& topic : topics_)
      if (is_transforms(topic) && !contains(choice_.transform_topics, topic.name))
        choice_.transform_topics.push_back(topic.name);
    choice_.transform_topics = robots_.of_robot(choice_.transform_topics, choice_.scan_topics.front());
    find_odometry_topics();
    find_imu_topics();
    return std::move(choice_);
  }

 private:
  void choose_scan_topics() {
    const Names clouds = topics_of_type(topics_, kRosPointCloud);
    Names lasers = topics_of_type(topics_, kRosLaserScan);
    for (const std::string& topic : topics_of_type(topics_, kRosMultiEchoScan)) lasers.push_back(topic);
    const Names& all = slices_clouds_ ? clouds : lasers;
    const char* type = slices_clouds_ ? kRosPointCloud : kRosLaserScan;
    if (all.empty()) report_missing_scans(clouds);
    Names nameable = all;
    if (slices_clouds_) nameable.insert(nameable.end(), lasers.begin(), lasers.end());
    const bool by_topic = !options_.scan_topic.empty();
    const char* option = by_topic ? "log.scan_topic" : "log.laser";
    const LaserChoice choice = laser_choice(option, by_topic ? options_.scan_topic : options_.laser);
    if (choice.all) choice_.scan_topics = all;
    for (const std::string& name : choice.names) {
      if (!slices_clouds_ && contains(clouds, as_in_bag(name, clouds)))
        throw UserError(std::string(option) + " names the point clouds on " + name + " of " + path_ +
                        ". Map a slice of them with log.slice_z_m, such as \"0.1 1.0\" (heights above the "
                        "floor in metres)");
      const std::string topic = choose(option, name, nameable, type);
      if (contains(choice_.scan_topics, topic))
        throw UserError(std::string(option) + " names the topic " + topic + " twice. Name each topic once");
      choice_.scan_topics.push_back(topic);
    }
    if (choice_.scan_topics.empty() && options_.robot_T_laser)
      choice_.scan_topics = {choose("log.scan_topic", "", all, type)};
    if (choice_.scan_topics.empty()) {
      Names ranked = all;
      if (robots_.are_several())
        std::stable_partition(ranked.begin(), ranked.end(),
                              [&](const std::string& topic) { return robots_.has_robot(topic); });
      choice_.scan_topics = robots_.of_robot(ranked, ranked.front());
      choice_.chooses_lasers = all.size() > 1;
    }
    for (const auto& [option_of_laser, name] : lasers_with_stated_values(options_))
      choose(option_of_laser, name, nameable, type);
  }

  /// Throws UserError for a bag without scans, or without point clouds if the user asks for them.
  [[noreturn]] void report_missing_scans(const Names& clouds) const {
    if (!clouds.empty())
      throw UserError(path_ + " has no laser scans, but point clouds on " + name_list(clouds) +
                      ". Map a slice of them with log.slice_z_m, such as \"0.1 1.0\" (heights above the "
                      "floor in metres)");
    Names found;
    for (const BagTopic& topic : topics_) found.push_back(topic.name + " (" + topic.type + ")");
    throw UserError(path_ + " has no " +
                    (slices_clouds_ ? std::string("point clouds, expected a topic of type ") + kRosPointCloud
                                    : std::string("laser scans, expected a topic of type ") + kRosLaserScan) +
                    "; found " + (found.empty() ? "no topics" : name_list(found)) +
                    (slices_clouds_ ? ". Map laser scans with an empty log.slice_z_m"
                                    : ". Record the scans with the bag"));
  }

  void find_imu_topics() {
    const Names all = ignores_gyroscope(options_) ? Names() : topics_of_type(topics_, kRosImu);
    if (!names_gyroscope(options_)) {
      choice_.imu_topics = robots_.of_robot(all, choice_.scan_topics.front());
      return;
    }
    choice_.imu = choose("log.imu", options_.imu, all, kRosImu);
    choice_.imu_topics = {choice_.imu};
  }

  /// Finds the topics of odometry from which choose_odometry_topic() chooses: one if the user names it.
  void find_odometry_topics() {
    const Names all = topics_of_type(topics_, kRosOdometry);
    const std::string wanted = chooses_odometry(options_) ? "" : options_.odometry;
    choice_.expects_odometry =
        !ignores_odometry(options_) && !(wanted.empty() && all.empty() && choice_.transform_topics.empty());
    const bool by_transform = contains(choice_.transform_topics, as_in_bag(wanted, choice_.transform_topics));
    if (!choice_.expects_odometry || by_transform) return;
    choice_.odometry_topics = wanted.empty() ? robots_.of_robot(all, choice_.scan_topics.front())
                                             : Names{choose("log.odometry", wanted, all, kRosOdometry)};
    if (choice_.odometry_topics.empty() && !all.empty())
      choice_.assumptions.push_back("the odometry of " + name_list(all) +
                                    " is not used, because it is that of another robot than the scans of " +
                                    choice_.scan_topics.front() + ". Name a topic with log.odometry");
  }

  std::string choose(const char* option, const std::string& wanted, const Names& all,
                     const char* type) const {
    if (wanted.empty() && all.size() > 1)
      throw UserError(path_ + " has several topics of type " + type + ": " + name_list(all) +
                      ". Select one with " + option);
    if (wanted.empty()) return all.front();
    if (const std::string name = as_in_bag(wanted, all); contains(all, name)) return name;
    throw UserError(std::string(option) + " is \"" + wanted + "\", expected a topic of type " + type +
                    " of " + path_ + ": " + (all.empty() ? "it has none" : name_list(all)));
  }

  const std::vector<BagTopic>& topics_;
  const BagRobots& robots_;
  std::string path_;
  const LogOptions& options_;
  bool slices_clouds_;  // whether scans are slices of point clouds
  BagTopics choice_;
};

}  // namespace

bool has_scans(const BagTopic& topic, bool slices_clouds) {
  return slices_clouds ? topic.type == kRosPointCloud
                       : topic.type == kRosLaserScan || topic.type == kRosMultiEchoScan;
}

bool is_transforms(const BagTopic& topic) {
  return (topic.type == kRosTransforms || topic.type == kRosOldTransforms) &&
         topic.encoding != BagEncoding::kOther;
}

std::vector<std::string> names_of_topic(const std::string& topic) {
  if (topic.front() == '/') return {topic, topic.substr(1)};  // users may omit the slash
  return {topic};
}

LogOptions options_of_topic(const LogOptions& options, const std::string& topic) {
  return options_of_laser(options, names_of_topic(topic));
}

bool states_mount(const LogOptions& options, const std::string& topic) {
  return options_of_topic(options, topic).robot_T_laser.has_value();
}

BagTopics choose_topics(const std::vector<BagTopic>& topics, const BagRobots& robots, const std::string& path,
                        const LogOptions& options) {
  return TopicChooser(topics, robots, path, options).choose();
}

}  // namespace psi_slam
