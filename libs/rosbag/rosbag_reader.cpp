// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/rosbag_reader.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "base/byte_cursor.h"
#include "frames/laser_choice.h"
#include "frames/odometry_interpolator.h"
#include "psi_slam/user_error.h"
#include "rosbag/bag_plan.h"
#include "rosbag/ros_laser.h"

namespace psi_slam {
namespace {

mrpt::math::TPose2D on_floor(const mrpt::math::TPose3D& pose) {
  return {pose.x, pose.y, pose.yaw};
}

class RosbagReader : public LogReader {
 public:
  RosbagReader(const std::filesystem::path& path, const LogOptions& options)
      : plan_(plan_bag(path, options)), bag_(open_bag(path)) {
    bag_->want(plan_.topics());
    contents_.laser = name_list(plan_.scan_topics);
    for (const std::string& topic : plan_.scan_topics) lasers_.emplace_back(options_of_topic(options, topic));
    contents_.odometry =
        plan_.odometry_topic.empty() ? plan_.odom_frame + " -> " + plan_.base_frame : plan_.odometry_topic;
  }

  double progress() const override { return at_end_ ? 1 : bag_->progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    while (true) {
      if (auto frame = interpolator_.take()) return frame;
      if (at_end_) return end();
      read_message();
    }
  }

 private:
  /// After an error no odometry follows, so the waiting scans leave first. Then the error is thrown.
  void read_message() {
    try {
      BagMessage message;
      if (bag_->next(message)) {
        take(message);
        return;
      }
    } catch (const UserError&) {
      failure_ = std::current_exception();
    }
    at_end_ = true;
    interpolator_.end_of_log();
  }

  std::optional<Frame> end() {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::nullopt;
  }

  void take(const BagMessage& message) {
    try {
      if (is_transforms(*message.topic)) {
        for (const RosTransform& transform : read_ros_transforms(message)) take_transform(transform);
      } else if (message.topic->name == plan_.odometry_topic) {
        take_odometry(message);
      } else {
        take_scan(read_ros_laser_scan(message), laser_of(message.topic->name));
      }
    } catch (const MalformedBytes& error) {
      throw UserError(bag_->place() + ": the message on " + message.topic->name +
                      " is damaged: " + error.what());
    }
  }

  void take_transform(const RosTransform& transform) {
    const bool is_odometry = plan_.odometry_topic.empty() && transform.child_frame == plan_.base_frame &&
                             transform.header.frame == plan_.odom_frame;
    if (is_odometry) {
      interpolator_.add_odometry(transform.header.time_us, on_floor(transform.pose));
    } else {
      plan_.transforms.add(transform);
    }
  }

  void take_odometry(const BagMessage& message) {
    if (const auto odometry = read_ros_odometry(message)) {
      interpolator_.add_odometry(odometry->header.time_us, on_floor(odometry->pose));
      return;
    }
    if (contents_.skipped.count++ == 0)
      contents_.skipped.first = bag_->place() + ": " + invalid_pose_text(message.topic->name);
  }

  std::size_t laser_of(const std::string& topic) const {
    const auto& topics = plan_.scan_topics;
    return static_cast<std::size_t>(std::find(topics.begin(), topics.end(), topic) - topics.begin());
  }

  void take_scan(RosLaserScan message, std::size_t laser) {
    if (message.ranges_m.empty()) return;
    const auto robot_T_laser = plan_.transforms.base_T_frame(plan_.base_frame, message.header.frame);
    const FloorMount mount = robot_T_laser ? floor_mount(*robot_T_laser, bag_->place()) : FloorMount{};
    Frame frame;
    frame.time_us = message.header.time_us;
    frame.scan = lasers_[laser].scan(std::move(message), mount, bag_->place());
    frame.scan.laser = laser;
    interpolator_.add_scan(std::move(frame));
  }

  BagPlan plan_;
  std::unique_ptr<BagFile> bag_;
  std::vector<RosLaser> lasers_;  // in the order of the plan's topics
  OdometryInterpolator interpolator_;
  std::exception_ptr failure_;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_bag_log(const std::filesystem::path& path, const LogOptions& options) {
  return std::make_unique<RosbagReader>(path, options);
}

}  // namespace psi_slam
