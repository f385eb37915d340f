// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/bag_plan.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/byte_cursor.h"
#include "base/text_parts.h"
#include "frames/gyroscope_choice.h"
#include "frames/height_slice.h"
#include "frames/laser_choice.h"
#include "frames/log_reader.h"
#include "psi_slam/user_error.h"
#include "rosbag/bag_robots.h"
#include "rosbag/ros_messages.h"

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

class Planner {
 public:
  Planner(std::unique_ptr<BagFile> bag, const std::filesystem::path& path, const LogOptions& options)
      : path_(path.string()),
        options_(options),
        slices_clouds_(height_slice(options).has_value()),
        bag_(std::move(bag)),
        topics_(bag_->topics()),
        robots_(topics_) {}

  BagPlan plan() {
    choose_scan_topics();
    for (const BagTopic& topic : topics_)
      if (is_transforms(topic) && !contains(plan_.transform_topics, topic.name))
        plan_.transform_topics.push_back(topic.name);
    plan_.transform_topics = robots_.of_robot(plan_.transform_topics, plan_.scan_topics.front());
    find_odometry_topics();
    find_imu_topics();
    plan_.odom_frame = options_.odom_frame;
    plan_.base_frame = options_.base_frame;
    read_until_complete();
    require_scans();
    choose_odometry_topic();
    if (expects_odometry_ && !plan_.has_odometry) find_odometry_elsewhere();
    require_odometry();
    settle_base_frame();
    if (chooses_lasers_) {
      list_robots();
      keep_usable_lasers();
    }
    settle_mounts();
    settle_heights();
    settle_gyroscope();
    return std::move(plan_);
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
    if (choice.all) plan_.scan_topics = all;
    for (const std::string& name : choice.names) {
      if (!slices_clouds_ && contains(clouds, as_in_bag(name, clouds)))
        throw UserError(std::string(option) + " names the point clouds on " + name + " of " + path_ +
                        ". Map a slice of them with log.slice_z_m, such as \"0.1 1.0\" (heights above the "
                        "floor in metres)");
      const std::string topic = choose(option, name, nameable, type);
      if (contains(plan_.scan_topics, topic))
        throw UserError(std::string(option) + " names the topic " + topic + " twice. Name each topic once");
      plan_.scan_topics.push_back(topic);
    }
    if (plan_.scan_topics.empty() && options_.robot_T_laser)
      plan_.scan_topics = {choose("log.scan_topic", "", all, type)};
    if (plan_.scan_topics.empty()) {
      plan_.scan_topics = robots_.of_robot(all, all.front());
      chooses_lasers_ = all.size() > 1;
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
    imu_topics_ = ignores_gyroscope(options_) ? Names() : topics_of_type(topics_, kRosImu);
    if (!names_gyroscope(options_)) imu_topics_ = robots_.of_robot(imu_topics_, plan_.scan_topics.front());
    if (!names_gyroscope(options_)) return;
    options_.imu = choose("log.imu", options_.imu, imu_topics_, kRosImu);
    imu_topics_ = {options_.imu};
  }

  /// Finds the topics of odometry from which choose_odometry_topic() chooses: one if the user names it.
  void find_odometry_topics() {
    const Names all = topics_of_type(topics_, kRosOdometry);
    const std::string wanted = chooses_odometry(options_) ? "" : options_.odometry;
    expects_odometry_ =
        !ignores_odometry(options_) && !(wanted.empty() && all.empty() && plan_.transform_topics.empty());
    const bool by_transform = contains(plan_.transform_topics, as_in_bag(wanted, plan_.transform_topics));
    if (!expects_odometry_ || by_transform) return;
    odometry_topics_ = wanted.empty() ? robots_.of_robot(all, plan_.scan_topics.front())
                                      : Names{choose("log.odometry", wanted, all, kRosOdometry)};
    if (odometry_topics_.empty() && !all.empty())
      plan_.assumptions.push_back("the odometry of " + name_list(all) +
                                  " is not used, because it is that of another robot than the scans of " +
                                  plan_.scan_topics.front() + ". Name a topic with log.odometry");
  }

  /// Chooses the odometry of the first laser's robot: by namespace if the bag recorded several robots, by the
  /// transforms, then /odom, then the first topic. Topics with messages take precedence.
  void choose_odometry_topic() {
    if (odometry_topics_.empty()) return;
    const std::string scan_topic = plan_.scan_topics.front();
    const auto rank = [&](const std::string& topic) {
      const auto pose = odometry_.find(topic);
      const bool is_connected =
          pose != odometry_.end() &&
          are_on_one_robot(plan_.transforms, pose->second.child_frame, first_scan_frame());
      const bool is_of_robot = robots_.robot_of(topic) == robots_.robot_of(scan_topic);
      return std::make_tuple(pose == odometry_.end(), !(robots_.are_several() && is_of_robot), !is_connected,
                             topic != "/odom");
    };
    plan_.odometry_topic =
        *std::min_element(odometry_topics_.begin(), odometry_topics_.end(),
                          [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    const auto pose = odometry_.find(plan_.odometry_topic);
    if (pose == odometry_.end()) return;
    plan_.has_odometry = true;
    if (plan_.odom_frame.empty()) plan_.odom_frame = pose->second.header.frame;
    if (plan_.base_frame.empty()) plan_.base_frame = pose->second.child_frame;
    if (odometry_topics_.size() > 1 && !robots_.are_several())
      plan_.assumptions.push_back("odometry comes from " + plan_.odometry_topic + ", one of the topics " +
                                  name_list(odometry_topics_) + ". Name another one with log.odometry");
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

  void read_until_complete() {
    Names wanted = plan_.topics();
    wanted.insert(wanted.end(), imu_topics_.begin(), imu_topics_.end());
    wanted.insert(wanted.end(), odometry_topics_.begin(), odometry_topics_.end());
    bag_->want(wanted);
    for (BagMessage message; !is_complete();) {
      try {
        if (!bag_->next(message)) break;
        take(message);
      } catch (const MalformedBytes& error) {
        if (damage_.empty()) damage_ = damage_text(*bag_, message, error);
      } catch (const UserError&) {
        if (!has_enough_scans()) throw;
        return;
      }
    }
    if (!has_enough_scans() && !damage_.empty()) throw UserError(damage_);
  }

  void take(const BagMessage& message) {
    if (is_transforms(*message.topic)) {
      for (const RosTransform& transform : read_ros_transforms(message)) plan_.transforms.add(transform);
    } else if (message.topic->type == kRosOdometry) {
      take_odometry(message);
    } else if (message.topic->type == kRosImu) {
      take_imu(message);
    } else if (message.topic->type == kRosPointCloud) {
      scan_frames_.emplace(message.topic->name, read_ros_header(message).frame);
    } else {
      scan_frames_.emplace(message.topic->name, read_ros_laser_scan(message).header.frame);
    }
    if (expects_odometry_ && odometry_topics_.empty() && !plan_.has_odometry) find_odometry_transform();
  }

  void take_odometry(const BagMessage& message) {
    const std::optional<RosTransform> odometry = read_ros_odometry(message);
    if (!odometry && invalid_pose_.empty())
      invalid_pose_ = bag_->place() + ": " + invalid_pose_text(message.topic->name);
    if (odometry) odometry_.emplace(message.topic->name, *odometry);
  }

  void take_imu(const BagMessage& message) {
    if (!seen_imus_.insert(message.topic->name).second) return;
    const RosImu imu = read_ros_imu(message);
    if (imu.rate_radps) gyroscope_frames_.emplace(message.topic->name, imu.header.frame);
  }

  /// Searches the frames above the lasers, and above the robot's frame if the user states it, for the frame
  /// of the odometry.
  void find_odometry_transform() {
    Names starts;
    if (!options_.base_frame.empty()) starts.push_back(options_.base_frame);
    for (const auto& [topic, frame] : scan_frames_) starts.push_back(frame);
    for (const std::string& start : starts) {
      const Names way = plan_.transforms.way_up(start);
      for (std::size_t i = 1; i < way.size(); ++i) {
        const bool is_stated_base = way[i - 1] == options_.base_frame;
        const bool is_odometry = options_.odom_frame.empty()
                                     ? is_stated_base || is_named_like_odometry(way[i])
                                     : way[i] == options_.odom_frame;
        if (!is_odometry) continue;
        plan_.has_odometry = true;
        plan_.odom_frame = way[i];
        plan_.base_frame = way[i - 1];
        return;
      }
    }
  }

  /// Returns whether transforms lead from the robot's frame to `frame`. While the bag is read, the frame of
  /// any topic of odometry may become the robot's.
  bool knows_mount(const std::string& frame) const {
    if (!plan_.base_frame.empty()) return plan_.transforms.base_T_frame(plan_.base_frame, frame).has_value();
    return std::any_of(odometry_.begin(), odometry_.end(), [&](const auto& odometry) {
      return plan_.transforms.base_T_frame(odometry.second.child_frame, frame).has_value();
    });
  }

  bool states_mount(const std::string& topic) const {
    return options_of_topic(options_, topic).robot_T_laser.has_value();
  }

  /// Returns whether odometry, scans of all lasers and all mounts are known. Transforms are needed even for a
  /// stated mount, because they show whether the laser is upside down.
  bool is_complete() const {
    const bool has_transforms = !plan_.transform_topics.empty();
    const bool has_odometry =
        plan_.has_odometry || (!odometry_.empty() && odometry_.size() == odometry_topics_.size());
    const bool has_motion = has_odometry || (!expects_odometry_ && seen_imus_.size() == imu_topics_.size());
    const auto has_mount = [&](const auto& sensor) { return !has_transforms || knows_mount(sensor.second); };
    return has_motion && has_scans() && std::all_of(scan_frames_.begin(), scan_frames_.end(), has_mount) &&
           (has_odometry || std::all_of(gyroscope_frames_.begin(), gyroscope_frames_.end(), has_mount));
  }

  /// Returns whether a scan of each topic has been read.
  bool has_scans() const { return scan_frames_.size() == plan_.scan_topics.size(); }

  /// Returns whether scans were read that can be mapped if the bag ends here.
  bool has_enough_scans() const { return has_scans() || (chooses_lasers_ && !scan_frames_.empty()); }

  /// Searches all transforms for odometry, because the topic has none, or because no transform connects it
  /// with a laser.
  void find_odometry_elsewhere() {
    if (chooses_odometry(options_)) plan_.odometry_topic.clear();
    if (!plan_.odometry_topic.empty()) return;
    if (!invalid_pose_.empty())
      plan_.assumptions.push_back(invalid_pose_ +
                                  ", as in all of its messages, so this topic is not used. Name another one "
                                  "with log.odometry");
    const auto is_parent = [&](const std::string& parent) {
      return options_.odom_frame.empty() ? is_named_like_odometry(parent) : parent == options_.odom_frame;
    };
    const std::string& stated = options_.base_frame;
    const std::optional<std::string> base = !stated.empty() && is_parent(plan_.transforms.parent_of(stated))
                                                ? stated
                                            : stated.empty() ? plan_.transforms.child_of(is_parent)
                                                             : std::nullopt;
    if (!base) return;
    plan_.has_odometry = true;
    plan_.base_frame = *base;
    plan_.odom_frame = plan_.transforms.parent_of(*base);
  }

  /// Chooses the robot's frame if neither the user nor the odometry states it, or if odometry states a frame
  /// that no transform connects with a laser, although another frame has the name of a base.
  void settle_base_frame() {
    const std::string by_name = base_frame_by_name();
    const bool is_alone = options_.base_frame.empty() && !plan_.odometry_topic.empty() &&
                          !knows_mount(first_scan_frame()) && has_word(by_name, "base");
    if (plan_.base_frame.empty() || is_alone) plan_.base_frame = by_name;
  }

  /// Returns the robot's frame for a bag without odometry: the topmost frame above the first laser whose name
  /// contains "base". Otherwise the nearest frame above all lasers, such as the frame of a single laser.
  std::string base_frame_by_name() const {
    const Names way = plan_.transforms.way_up(first_scan_frame());
    const auto base = std::find_if(way.rbegin(), way.rend(),
                                   [](const std::string& frame) { return has_word(frame, "base"); });
    if (base != way.rend()) return *base;
    const auto is_above_all = [&](const std::string& frame) {
      return std::all_of(scan_frames_.begin(), scan_frames_.end(), [&](const auto& scan) {
        return contains(plan_.transforms.way_up(scan.second), frame);
      });
    };
    const auto common = std::find_if(way.begin(), way.end(), is_above_all);
    return common == way.end() ? way.front() : *common;
  }

  /// First topic of scans with a message.
  std::string first_scan_topic() const {
    const auto known = std::find_if(plan_.scan_topics.begin(), plan_.scan_topics.end(),
                                    [&](const auto& topic) { return scan_frames_.count(topic) > 0; });
    return known == plan_.scan_topics.end() ? "" : *known;
  }

  std::string first_scan_frame() const {
    const auto known = scan_frames_.find(first_scan_topic());
    return known == scan_frames_.end() ? "" : known->second;
  }

  /// Name of the robot with a laser: the namespace of its topic if those tell robots apart, otherwise the
  /// frame that odometry moves. Empty if neither is known.
  std::string robot_with(const std::string& topic) const {
    if (robots_.are_several()) return '/' + robots_.robot_of(topic);
    const auto scan = scan_frames_.find(topic);
    if (scan == scan_frames_.end()) return {};
    const Names way = plan_.transforms.way_up(scan->second);
    for (std::size_t i = 1; i < way.size(); ++i)
      if (is_named_like_odometry(way[i])) return way[i - 1];
    for (const auto& [name, odometry] : odometry_)
      if (contains(way, odometry.child_frame)) return odometry.child_frame;
    return {};
  }

  /// Lists the robots if the bag recorded several.
  void list_robots() {
    std::map<std::string, Names> robots;
    for (const BagTopic& topic : topics_)
      if (is_scan(topic))
        if (const std::string robot = robot_with(topic.name); !robot.empty())
          robots[robot].push_back(topic.name);
    if (robots.size() < 2) return;
    std::string list;
    for (const auto& [robot, topics] : robots)
      list += (list.empty() ? "" : ", ") + robot + " (" + name_list(topics) + ")";
    plan_.assumptions.push_back("the bag recorded " + std::to_string(robots.size()) + " robots: " + list +
                                ". " + robot_with(first_scan_topic()) +
                                " is mapped; select the scans of another one with log.scan_topic");
  }

  /// Keeps the lasers of the first laser's robot with a known mount, or the first laser if no mount is known.
  /// Of several topics with scans of one laser, keeps the first by rank and names all in the plan.
  void keep_usable_lasers() {
    Names ranked = plan_.scan_topics;
    std::stable_sort(ranked.begin(), ranked.end(), [](const std::string& a, const std::string& b) {
      return std::make_pair(a.size(), a) < std::make_pair(b.size(), b);
    });
    Names kept;
    Names left_out;
    std::map<std::string, Names> topics_of_frame;
    for (const std::string& topic : ranked)
      if (const auto scan = scan_frames_.find(topic); scan != scan_frames_.end())
        topics_of_frame[scan->second].push_back(topic);
    for (const bool known : {true, false}) {
      if (!kept.empty()) break;
      for (const std::string& topic : plan_.scan_topics) {
        const auto scan = scan_frames_.find(topic);
        if (scan == scan_frames_.end() || (!known && !kept.empty())) continue;
        const std::string& frame = scan->second;
        if (known && !states_mount(topic) &&
            !(knows_mount(frame) && are_on_one_robot(plan_.transforms, plan_.base_frame, frame)))
          continue;
        const Names& topics = topics_of_frame.at(frame);
        if (contains(kept, topics.front())) continue;
        kept.push_back(topics.front());
        if (topics.size() > 1) plan_.rival_topics.push_back(topics);
      }
    }
    for (const std::string& topic : plan_.scan_topics) {
      const bool is_rival = std::any_of(plan_.rival_topics.begin(), plan_.rival_topics.end(),
                                        [&](const Names& rivals) { return contains(rivals, topic); });
      if (!contains(kept, topic) && !is_rival && scan_frames_.count(topic) > 0) left_out.push_back(topic);
    }
    plan_.scan_topics = kept;
    if (!left_out.empty())
      plan_.assumptions.push_back("the scans of " + name_list(left_out) +
                                  " are not used, because the mount of their " +
                                  (left_out.size() == 1 ? "laser" : "lasers") +
                                  " on the robot is unknown. Select topics with log.scan_topic");
  }

  void require_scans() const {
    const auto is_missing = [&](const std::string& topic) { return scan_frames_.count(topic) == 0; };
    const Names& topics = plan_.scan_topics;
    if (chooses_lasers_ && !std::all_of(topics.begin(), topics.end(), is_missing)) return;
    if (const auto missing = std::find_if(topics.begin(), topics.end(), is_missing); missing != topics.end())
      throw UserError(path_ + " has no message on the topic " + *missing +
                      ". Select another topic of scans with log.scan_topic.");
  }

  /// Throws UserError if odometry that the user or the bag states is missing.
  void require_odometry() const {
    if (plan_.has_odometry || !expects_odometry_) return;
    if (!plan_.odometry_topic.empty() && !invalid_pose_.empty())
      throw UserError(invalid_pose_ +
                      ", as in all of its messages. Select another topic with log.odometry, or map without "
                      "odometry with log.odometry=none");
    if (!plan_.odometry_topic.empty())
      throw UserError(path_ + " has no message on the topic " + plan_.odometry_topic +
                      ". Select another topic with log.odometry, or map without odometry with "
                      "log.odometry=none");
    if (!chooses_odometry(options_) || !options_.odom_frame.empty())
      throw UserError(
          path_ + " has no odometry, expected a transform from " +
          (options_.odom_frame.empty() ? "a frame named like \"odom\"" : '"' + options_.odom_frame + '"') +
          " to the robot's frame. Name the frames with log.odom_frame and log.base_frame, or map "
          "without odometry with log.odometry=none. Transforms of the bag: " +
          plan_.transforms.text());
  }

  /// Throws UserError if the mount of one of several lasers is unknown, or if the user names the robot's
  /// frame and no transform leads to the laser. Otherwise an unknown mount is the robot's centre.
  void settle_mounts() {
    for (const std::string& topic : plan_.scan_topics) {
      const std::string& frame = scan_frames_.at(topic);
      if (states_mount(topic) || knows_mount(frame)) continue;
      const bool several = plan_.scan_topics.size() > 1;
      const std::string reason = "no transform leads from \"" + plan_.base_frame + "\" to \"" + frame + "\"";
      const std::string remedy = several ? "log.laser_mounts, such as \"" + topic + " 0.2 0 0\""
                                         : "log.laser_x_m, log.laser_y_m and log.laser_yaw_deg";
      if (several || !options_.base_frame.empty())
        throw UserError(path_ + " does not state where the laser of " + topic + " is mounted: " + reason +
                        ". Name the robot's frame with log.base_frame, or state the mount with " + remedy +
                        ". Transforms of the bag: " + plan_.transforms.text());
      plan_.assumptions.push_back("the laser of " + topic +
                                  " is assumed at the robot's centre, facing ahead, because " + reason +
                                  ". State its mount with " + remedy);
    }
  }

  /// Tells where heights are measured from if no transform leads from the robot's frame to a sensor.
  void settle_heights() {
    for (const std::string& topic : plan_.scan_topics) {
      const std::string& frame = scan_frames_.at(topic);
      const bool is_alone = frame == plan_.base_frame && options_.base_frame.empty();
      if (!is_cloud(topic) || (knows_mount(frame) && !is_alone)) continue;
      plan_.assumptions.push_back("the heights of log.slice_z_m are measured from the sensor of " + topic +
                                  ", because no transform leads from the robot's frame to \"" + frame +
                                  "\". Subtract the sensor's height above the floor from log.slice_z_m, or "
                                  "name the robot's frame with log.base_frame");
    }
  }

  /// Returns whether the topic has scans, or clouds if these are sliced.
  bool is_scan(const BagTopic& topic) const {
    return slices_clouds_ ? topic.type == kRosPointCloud
                          : topic.type == kRosLaserScan || topic.type == kRosMultiEchoScan;
  }

  bool is_cloud(const std::string& topic) const {
    return std::any_of(topics_.begin(), topics_.end(),
                       [&](const BagTopic& one) { return one.name == topic && one.type == kRosPointCloud; });
  }

  /// Chooses the gyroscope for a bag without odometry.
  void settle_gyroscope() {
    Names gyroscopes;
    for (const std::string& topic : imu_topics_)
      if (plan_.has_odometry || gyroscope_frames_.count(topic) > 0) gyroscopes.push_back(topic);
    const GyroscopeChoice choice =
        choose_gyroscope(options_, gyroscopes, plan_.has_odometry,
                         std::string("a topic of type ") + kRosImu + " with angular velocities of " + path_);
    if (!choice.assumption.empty()) plan_.assumptions.push_back(choice.assumption);
    if (!choice.name) return;
    plan_.imu_topic = *choice.name;
    const std::string& frame = gyroscope_frames_.at(plan_.imu_topic);
    if (!knows_mount(frame))
      plan_.assumptions.push_back("the z axis of the gyroscope of " + plan_.imu_topic +
                                  " is assumed to point up, because no transform leads from \"" +
                                  plan_.base_frame + "\" to \"" + frame +
                                  "\". Ignore the gyroscope with log.imu=none");
  }

  std::string path_;
  LogOptions options_;
  bool slices_clouds_;  // whether scans are slices of point clouds
  std::unique_ptr<BagFile> bag_;
  std::vector<BagTopic> topics_;
  BagRobots robots_;
  BagPlan plan_;
  std::map<std::string, std::string> scan_frames_;  // key: topic of the scans; value: frame of the laser
  Names odometry_topics_;                           // topics of odometry to choose from
  std::map<std::string, RosTransform> odometry_;    // key: topic; value: its first valid odometry
  std::string damage_;                              // message about the first damaged message
  std::string invalid_pose_;                        // message about the first odometry with an invalid pose
  bool expects_odometry_ = true;                    // whether the user wants odometry and the bag may hold it
  bool chooses_lasers_ = false;      // whether the user selects none of several topics of scans
  Names imu_topics_;                 // topics of gyroscopes to choose from
  std::set<std::string> seen_imus_;  // topics of gyroscopes with a message
  std::map<std::string, std::string> gyroscope_frames_;  // key: topic with angular velocities; value: frame
};

}  // namespace

Names BagPlan::topics() const {
  Names all = scan_topics;
  if (!odometry_topic.empty()) all.push_back(odometry_topic);
  if (!imu_topic.empty()) all.push_back(imu_topic);
  all.insert(all.end(), transform_topics.begin(), transform_topics.end());
  return all;
}

std::string invalid_pose_text(const std::string& topic) {
  return "the odometry on " + topic +
         " is not finite, or the length of its quaternion is not 1, or it is beyond 10,000 km";
}

std::string damage_text(const BagFile& bag, const BagMessage& message, const MalformedBytes& damage) {
  return bag.place() + ": the message on " + message.topic->name + " is damaged: " + damage.what() +
         ". Record the bag again";
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

BagPlan plan_bag(std::unique_ptr<BagFile> bag, const std::filesystem::path& path, const LogOptions& options) {
  return Planner(std::move(bag), path, options).plan();
}

}  // namespace psi_slam
