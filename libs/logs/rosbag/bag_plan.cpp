// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/bag_plan.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/text_parts.h"
#include "logs/frames/gyroscope_choice.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_reader.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/heard_odometry.h"
#include "logs/rosbag/ros_messages.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Names = std::vector<std::string>;

class Planner {
 public:
  Planner(std::unique_ptr<BagFile> bag, const std::filesystem::path& path, const LogOptions& options,
          double look_over_s)
      : path_(path.string()),
        options_(options),
        slices_clouds_(height_slice(options).has_value()),
        bag_(std::move(bag)),
        topics_(bag_->topics()),
        robots_(topics_),
        chosen_(choose_topics(topics_, robots_, path_, options_)),
        heard_(chosen_.odometry_topics, look_over_s) {}

  BagPlan plan() {
    plan_.scan_topics = chosen_.scan_topics;
    plan_.transform_topics = chosen_.transform_topics;
    plan_.assumptions = chosen_.assumptions;
    if (!chosen_.imu.empty()) options_.imu = chosen_.imu;
    plan_.odom_frame = options_.odom_frame;
    plan_.base_frame = options_.base_frame;
    read_until_complete();
    require_scans();
    choose_odometry_topic();
    if (chosen_.expects_odometry && !plan_.has_odometry) find_odometry_elsewhere();
    require_odometry();
    settle_base_frame();
    if (chosen_.chooses_lasers) {
      list_robots();
      keep_usable_lasers();
    }
    settle_mounts();
    settle_heights();
    settle_gyroscope();
    return std::move(plan_);
  }

 private:
  /// Chooses the odometry of the first laser's robot: by namespace if the bag recorded several robots, topics
  /// that are not silent, by the transforms, then /odom, then by namespace, then the first topic.
  void choose_odometry_topic() {
    if (chosen_.odometry_topics.empty()) return;
    const auto rank = [&](const std::string& topic) {
      const auto pose = heard_.first().find(topic);
      const bool is_heard = pose != heard_.first().end();
      const bool is_connected =
          is_heard && are_on_one_robot(plan_.transforms, pose->second.child_frame, first_scan_frame());
      const bool is_of_robot = robots_.robot_of(topic) == robots_.robot_of(plan_.scan_topics[0]);
      return std::make_tuple(!is_heard, !(robots_.are_several() && is_of_robot), heard_.is_silent(topic),
                             !is_connected, topic != "/odom", !is_of_robot);
    };
    plan_.odometry_topic =
        *std::min_element(chosen_.odometry_topics.begin(), chosen_.odometry_topics.end(),
                          [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    const auto pose = heard_.first().find(plan_.odometry_topic);
    if (pose == heard_.first().end()) return;
    plan_.has_odometry = true;
    if (plan_.odom_frame.empty()) plan_.odom_frame = pose->second.header.frame;
    if (plan_.base_frame.empty()) plan_.base_frame = pose->second.child_frame;
    if (chosen_.odometry_topics.size() > 1 && !robots_.are_several())
      plan_.assumptions.push_back("odometry comes from " + plan_.odometry_topic + ", one of the topics " +
                                  name_list(chosen_.odometry_topics) +
                                  ". Name another one with log.odometry");
  }

  void read_until_complete() {
    Names wanted = plan_.topics();
    wanted.insert(wanted.end(), chosen_.imu_topics.begin(), chosen_.imu_topics.end());
    wanted.insert(wanted.end(), chosen_.odometry_topics.begin(), chosen_.odometry_topics.end());
    for (const BagTopic& topic : topics_)
      if (has_scans(topic, slices_clouds_)) wanted.push_back(topic.name);
    bag_->want(wanted);
    for (BagMessage message; !is_complete();) {
      try {
        if (!bag_->next(message)) break;
        take(message);
      } catch (const MalformedBytes& error) {
        if (damage_.empty()) damage_ = damage_text(*bag_, message, error);
      } catch (const DamagedPart& error) {
        if (damage_.empty()) damage_ = error.what();
      } catch (const UserError&) {
        if (!has_enough_scans()) throw;
        return;
      }
    }
    if (!has_enough_scans() && !damage_.empty()) throw UserError(damage_);
  }

  void take(const BagMessage& message) {
    if (has_scans(*message.topic, slices_clouds_)) heard_.add_scan(message.recorded_us);
    if (is_transforms(*message.topic)) {
      for (const RosTransform& transform : read_ros_transforms(message)) plan_.transforms.add(transform);
    } else if (message.topic->type == kRosOdometry) {
      take_odometry(message);
    } else if (message.topic->type == kRosImu) {
      take_imu(message);
    } else if (!contains(plan_.scan_topics, message.topic->name)) {
      return;
    } else if (message.topic->type == kRosPointCloud) {
      scan_frames_.emplace(message.topic->name, read_ros_header(message).frame);
    } else {
      scan_frames_.emplace(message.topic->name, read_ros_laser_scan(message).header.frame);
    }
    if (chosen_.expects_odometry && chosen_.odometry_topics.empty() && !plan_.has_odometry)
      find_odometry_transform();
  }

  void take_odometry(const BagMessage& message) {
    const std::optional<RosTransform> odometry = read_ros_odometry(message);
    if (!odometry && invalid_pose_.empty())
      invalid_pose_ = bag_->place() + ": " + invalid_pose_text(message.topic->name);
    if (odometry) heard_.add(message.topic->name, *odometry);
  }

  void take_imu(const BagMessage& message) {
    if (hears_no_more_imus() || !seen_imus_.insert(message.topic->name).second) return;
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
    return std::any_of(heard_.first().begin(), heard_.first().end(), [&](const auto& odometry) {
      return plan_.transforms.base_T_frame(odometry.second.child_frame, frame).has_value();
    });
  }

  /// Returns whether gyroscopes that begin later do not count: a bag that is being recorded does not show
  /// them.
  bool hears_no_more_imus() const { return heard_.is_over() && !gyroscope_frames_.empty(); }

  /// Returns whether odometry, scans of all lasers and all mounts are known. Transforms are needed even for a
  /// stated mount, because they show whether the laser is upside down.
  bool is_complete() const {
    const bool has_transforms = !plan_.transform_topics.empty();
    const bool has_odometry = plan_.has_odometry || heard_.is_complete();
    const bool has_gyroscope = seen_imus_.size() == chosen_.imu_topics.size() || hears_no_more_imus();
    const bool has_motion = has_odometry || (!chosen_.expects_odometry && has_gyroscope);
    const auto has_mount = [&](const auto& sensor) { return !has_transforms || knows_mount(sensor.second); };
    return has_motion && knows_scans() && std::all_of(scan_frames_.begin(), scan_frames_.end(), has_mount) &&
           (has_odometry || std::all_of(gyroscope_frames_.begin(), gyroscope_frames_.end(), has_mount));
  }

  /// Returns whether a scan of each topic has been read.
  bool knows_scans() const { return scan_frames_.size() == plan_.scan_topics.size(); }

  /// Returns whether scans were read that can be mapped if the bag ends here.
  bool has_enough_scans() const { return knows_scans() || (chosen_.chooses_lasers && !scan_frames_.empty()); }

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
    const std::string by_name = base_frame_by_name(plan_.transforms, scan_frames());
    const bool none_is_mounted = std::none_of(scan_frames_.begin(), scan_frames_.end(),
                                              [&](const auto& scan) { return knows_mount(scan.second); });
    const bool is_alone = options_.base_frame.empty() && !plan_.odometry_topic.empty() && none_is_mounted &&
                          has_word(by_name, "base");
    if (plan_.base_frame.empty() || is_alone) plan_.base_frame = by_name;
  }

  /// First topic of scans with a message.
  std::string first_scan_topic() const {
    const auto known = std::find_if(plan_.scan_topics.begin(), plan_.scan_topics.end(),
                                    [&](const auto& topic) { return scan_frames_.count(topic) > 0; });
    return known == plan_.scan_topics.end() ? "" : *known;
  }

  /// Frames of the lasers, in the order of their topics.
  Names scan_frames() const {
    Names frames;
    for (const std::string& topic : plan_.scan_topics)
      if (const auto scan = scan_frames_.find(topic); scan != scan_frames_.end())
        frames.push_back(scan->second);
    return frames;
  }

  std::string first_scan_frame() const {
    const Names frames = scan_frames();
    return frames.empty() ? "" : frames.front();
  }

  /// Name of the robot with a laser: the namespace of its topic if those tell robots apart, otherwise the
  /// frame of the robot's base, which odometry moves. Empty if neither is known.
  std::string robot_with(const std::string& topic) const {
    if (robots_.are_several()) return robots_.has_robot(topic) ? '/' + robots_.robot_of(topic) : "";
    const auto scan = scan_frames_.find(topic);
    if (scan == scan_frames_.end()) return {};
    const Names way = plan_.transforms.way_up(scan->second);
    for (std::size_t i = 1; i < way.size(); ++i)
      if (is_named_like_odometry(way[i]) && has_word(way[i - 1], "base")) return way[i - 1];
    for (const auto& [name, odometry] : heard_.first())
      if (contains(way, odometry.child_frame)) return odometry.child_frame;
    return {};
  }

  /// Lists the robots if the bag recorded several.
  void list_robots() {
    std::map<std::string, Names> robots;
    for (const BagTopic& topic : topics_)
      if (has_scans(topic, slices_clouds_))
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
    std::stable_sort(ranked.begin(), ranked.end(), [&](const std::string& a, const std::string& b) {
      return std::make_tuple(!states_mount(options_, a), a.size(), a) <
             std::make_tuple(!states_mount(options_, b), b.size(), b);
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
        if (known && !states_mount(options_, topic) &&
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
    if (chosen_.chooses_lasers && !std::all_of(topics.begin(), topics.end(), is_missing)) return;
    if (const auto missing = std::find_if(topics.begin(), topics.end(), is_missing); missing != topics.end())
      throw UserError(path_ + " has no message on the topic " + *missing +
                      ". Select another topic of scans with log.scan_topic.");
  }

  /// Throws UserError if odometry that the user or the bag states is missing.
  void require_odometry() const {
    if (plan_.has_odometry || !chosen_.expects_odometry) return;
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
      if (states_mount(options_, topic) || knows_mount(frame)) continue;
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

  bool is_cloud(const std::string& topic) const {
    return std::any_of(topics_.begin(), topics_.end(),
                       [&](const BagTopic& one) { return one.name == topic && one.type == kRosPointCloud; });
  }

  /// Chooses the gyroscope for a bag without odometry.
  void settle_gyroscope() {
    Names gyroscopes;
    for (const std::string& topic : chosen_.imu_topics)
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
  BagTopics chosen_;
  HeardOdometry heard_;
  BagPlan plan_;
  std::map<std::string, std::string> scan_frames_;  // key: topic of the scans; value: frame of the laser
  std::string damage_;                              // message about the first damaged message
  std::string invalid_pose_;                        // message about the first odometry with an invalid pose
  std::set<std::string> seen_imus_;                 // topics of gyroscopes with a message
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

BagPlan plan_bag(std::unique_ptr<BagFile> bag, const std::filesystem::path& path, const LogOptions& options,
                 double look_over_s) {
  return Planner(std::move(bag), path, options, look_over_s).plan();
}

}  // namespace psi_slam
