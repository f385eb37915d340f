// SPDX-License-Identifier: BSD-3-Clause
// Reads ROS bags of any kind (see bag_file.h). Scans are sensor_msgs/LaserScan messages, or slices of
// sensor_msgs/PointCloud2 messages. Odometry comes from nav_msgs/Odometry, or from the transform odom ->
// base_link, and is interpolated at the header stamp of each scan. A bag without odometry has scans only, or
// scans with the heading by a gyroscope (sensor_msgs/Imu). The laser's mount comes from the transforms. A
// message without a stamp has the time at which it was recorded.
//
// A damaged or truncated bag yields all frames before the damage, then a UserError. Messages that are invalid
// by themselves, and damaged chunks, are skipped and counted.
#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/byte_cursor.h"
#include "base/portable_math.h"
#include "base/text_parts.h"
#include "logs/frames/gyroscope_headings.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_readings.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/look_over.h"
#include "logs/frames/odometry_interpolator.h"
#include "logs/rosbag/bag_plan.h"
#include "logs/rosbag/begun_bag.h"
#include "logs/rosbag/odometry_agreement.h"
#include "logs/rosbag/rosbag_stream.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Returns the sweep time of a scan in seconds, or 0 if the stated time is implausible. Drivers may state 0,
/// more than the time between scans, or more than any laser needs. A negative time_increment means that the
/// last beam is measured first.
float sweep_time_s(const RosLaserScan& message) {
  constexpr float kMaxSweep_s = 1;
  const float sweep_s = message.time_increment_s * static_cast<float>(message.ranges_m.size() - 1);
  const float max_sweep_s =
      message.scan_time_s > 0 ? std::min(kMaxSweep_s, 1.5F * message.scan_time_s) : kMaxSweep_s;
  return std::abs(sweep_s) <= max_sweep_s ? sweep_s : 0;  // NaN fails the comparison
}

/// Converts the scans of one topic to LaserScans. The user's options override the messages. The number of
/// beams and the angles may differ between messages.
class RosLaser {
 public:
  explicit RosLaser(const LogOptions& options) : options_(options) {}

  /// Converts a message. `mount` is the laser's mount according to the transforms. A pose that the user
  /// states overrides the pose of `mount`, but not whether the laser is upside down. Throws UserError that
  /// starts with `place` for invalid angles.
  LaserScan scan(RosLaserScan message, const FloorMount& mount, const std::string& place) {
    const bool clockwise = mount.upside_down != options_.mirrored;
    const Geometry geometry{message.ranges_m.size(), message.angle_min_rad, message.angle_increment_rad,
                            clockwise};
    const bool has_angles = std::isfinite(message.angle_min_rad) &&
                            std::isfinite(message.angle_increment_rad) &&
                            (message.ranges_m.size() < 2 || message.angle_increment_rad != 0);
    if (!has_angles)
      throw UserError(place + ": the scan's angles start at " + std::to_string(message.angle_min_rad) +
                      " in steps of " + std::to_string(message.angle_increment_rad) +
                      " radians, expected finite angles and a step other than 0. Correct the laser's driver");
    if (!bearings_ || geometry != geometry_) {
      if (const auto fault =
              fault_of_beams(message.ranges_m.size(), static_cast<double>(message.angle_min_rad),
                             static_cast<double>(message.angle_increment_rad)))
        throw UserError(place + ": " + *fault);
      bearings_ = std::make_shared<const std::vector<float>>(bearings_rad(message, clockwise));
      geometry_ = geometry;
    }
    LaserScan scan;
    scan.bearings_rad = bearings_;
    scan.robot_T_laser = options_.robot_T_laser.value_or(mount.robot_T_laser);
    scan.sweep_time_s = sweep_time_s(message);
    scan.ranges_m = std::move(message.ranges_m);
    limit_ranges(scan, options_,
                 std::isfinite(message.range_max_m) ? static_cast<double>(message.range_max_m) : 0,
                 static_cast<double>(message.range_min_m));
    return scan;
  }

 private:
  using Geometry = std::tuple<std::size_t, float, float, bool>;  // beams, first bearing, step, clockwise

  std::vector<float> bearings_rad(const RosLaserScan& message, bool clockwise) const {
    const auto step_rad = static_cast<double>(message.angle_increment_rad);
    const std::size_t beams = message.ranges_m.size();
    std::vector<float> bearings(beams);
    if (options_.beam_angles == BeamAngles::kAuto && !options_.field_of_view_rad) {
      if (auto even = bearings_of_whole_degrees(message.angle_min_rad, step_rad, beams))
        bearings = std::move(even->bearings_rad);
      else
        for (std::size_t i = 0; i < beams; ++i)
          bearings[i] = static_cast<float>(static_cast<double>(message.angle_min_rad) +
                                           static_cast<double>(i) * step_rad);
    } else {
      const bool is_auto = options_.beam_angles == BeamAngles::kAuto;
      const double steps = static_cast<double>(std::max<std::size_t>(beams - 1, 1));
      const double span_rad = std::min(std::abs(step_rad) * steps, 2 * M_PI);
      bearings = make_bearings_rad(is_auto ? BeamAngles::kCentredStepInclusive : options_.beam_angles, beams,
                                   options_.field_of_view_rad.value_or(span_rad));
      if (step_rad < 0) mirror(bearings);
    }
    if (clockwise) mirror(bearings);
    return bearings;
  }

  LogOptions options_;
  Geometry geometry_;  // geometry of bearings_
  BeamBearings bearings_;
};

class RosbagReader : public LogReader {
 public:
  /// `is_stream`: the bag is still being recorded.
  RosbagReader(BagPlan plan, std::unique_ptr<BagFile> bag, const LogOptions& options, bool is_stream)
      : plan_(std::move(plan)),
        bag_(std::move(bag)),
        slice_(height_slice(options)),
        interpolator_(is_stream ? kMostWaitingOfStream : OdometryInterpolator::kMaxWaiting) {
    bag_->want(plan_.topics());
    if (!plan_.has_odometry) interpolator_.expect_no_odometry();
    contents_.laser = name_list(plan_.scan_topics);
    contents_.several_lasers = plan_.scan_topics.size() > 1;
    contents_.assumptions = plan_.assumptions;
    for (const std::string& topic : plan_.scan_topics) {
      contents_.laser_names.push_back(names_of_topic(topic));
      sensor_options_.push_back(options_of_topic(options, topic));
      lasers_.emplace_back(sensor_options_.back());
    }
  }

  double progress() const override { return at_end_ ? 1 : bag_->progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    while (true) {
      if (auto frame = uses_gyroscope() ? headings_.take() : interpolator_.take()) return frame;
      if (at_end_) {
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
        if (frames_read() == 0 && invalid_.count > 0) throw UserError(invalid_.first);
        return std::nullopt;
      }
      try {
        BagMessage message;
        if (bag_->next(message)) {
          take_or_skip(message);
          continue;
        }
      } catch (const DamagedPart& error) {
        skip(error);
        continue;
      } catch (const UserError&) {
        failure_ = std::current_exception();  // thrown after the scans that wait for odometry
      }
      at_end_ = true;
      interpolator_.end_of_log();
      headings_.end_of_log();
    }
  }

 private:
  void take_or_skip(const BagMessage& message) {
    try {
      take(message);
    } catch (const UserError& error) {
      skip(error);
    }
  }

  void skip(const UserError& error) {
    if (invalid_.count++ == 0) invalid_.first = error.what();
    if (contents_.skipped.count++ == 0) contents_.skipped.first = error.what();
  }

  bool uses_gyroscope() const { return !plan_.imu_topic.empty(); }

  void take(const BagMessage& message) {
    try {
      if (is_transforms(*message.topic)) {
        for (const RosTransform& transform : read_ros_transforms(message)) take_transform(transform);
      } else if (message.topic->name == plan_.odometry_topic) {
        take_odometry(message);
      } else if (message.topic->name == plan_.imu_topic) {
        take_imu(read_ros_imu(message));
      } else if (message.topic->type == kRosPointCloud) {
        take_cloud(read_ros_point_cloud(message), laser_of(message.topic->name));
      } else {
        take_scan(read_ros_laser_scan(message), laser_of(message.topic->name));
      }
    } catch (const MalformedBytes& error) {
      throw UserError(damage_text(*bag_, message, error));
    }
  }

  void take_transform(const RosTransform& transform) {
    const bool is_odometry = plan_.has_odometry && plan_.odometry_topic.empty() &&
                             transform.child_frame == plan_.base_frame &&
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

  void take_imu(const RosImu& imu) {
    if (!imu.rate_radps) return;
    const auto robot_T_imu = plan_.transforms.base_T_frame(plan_.base_frame, imu.header.frame);
    headings_.add_rate(imu.header.time_us,
                       vertical_rate_radps(robot_T_imu.value_or(mrpt::poses::CPose3D()), *imu.rate_radps));
  }

  std::size_t laser_of(const std::string& topic) const {
    const auto& topics = plan_.scan_topics;
    return static_cast<std::size_t>(std::find(topics.begin(), topics.end(), topic) - topics.begin());
  }

  void take_scan(RosLaserScan message, std::size_t laser) {
    if (message.ranges_m.empty()) return;
    const auto robot_T_laser = plan_.transforms.base_T_frame(plan_.base_frame, message.header.frame);
    const FloorMount mount = robot_T_laser ? floor_mount(*robot_T_laser, bag_->place()) : FloorMount{};
    const TimeUs time_us = message.header.time_us;
    add_scan(time_us, lasers_[laser].scan(std::move(message), mount, bag_->place()), laser);
  }

  void take_cloud(const RosPointCloud& cloud, std::size_t laser) {
    const auto robot_T_sensor = plan_.transforms.base_T_frame(plan_.base_frame, cloud.header.frame);
    if (robot_T_sensor &&
        !is_possible_mount({robot_T_sensor->x(), robot_T_sensor->y(), robot_T_sensor->yaw()}))
      throw UserError(
          bag_->place() + ": the pose of the sensor on the robot is " + robot_T_sensor->asString() +
          ", expected finite numbers and at most 100 m. Select another topic with log.scan_topic");
    add_scan(cloud.header.time_us,
             scan_of_slice(cloud.points, robot_T_sensor.value_or(mrpt::poses::CPose3D()), slice_.value(),
                           sensor_options_[laser]),
             laser);
  }

  void add_scan(TimeUs time_us, LaserScan scan, std::size_t laser) {
    Frame frame;
    frame.time_us = time_us;
    frame.scan = std::move(scan);
    frame.scan.laser = laser;
    frame.has_odometry = plan_.has_odometry;
    uses_gyroscope() ? headings_.add_scan(std::move(frame)) : interpolator_.add_scan(std::move(frame));
  }

  BagPlan plan_;
  std::unique_ptr<BagFile> bag_;
  SkippedLines invalid_;  // messages besides odometry with an invalid pose
  std::optional<HeightSlice> slice_;
  std::vector<LogOptions> sensor_options_;  // in the order of plan_.scan_topics
  std::vector<RosLaser> lasers_;            // in the order of plan_.scan_topics
  OdometryInterpolator interpolator_;
  GyroscopeHeadings headings_;  // instead of interpolator_ if a gyroscope is used
  std::exception_ptr failure_;
  bool at_end_ = false;
};

/// Selects from each list of BagPlan::rival_topics the first topic whose scans do not clearly disagree more
/// with odometry than those of another one. Topics whose mounts the user states take precedence. `open` opens
/// the bag.
BagPlan with_agreeing_topics(BagPlan plan, const LogOptions& options,
                             const std::function<std::unique_ptr<BagFile>()>& open) {
  for (const std::vector<std::string>& rivals : plan.rival_topics) {
    std::vector<OdometryDisagreement> disagreements;
    for (const std::string& topic : rivals) {
      if (states_mount(options, topic) != states_mount(options, rivals.front())) break;
      BagPlan one = plan;
      one.scan_topics = {topic};
      RosbagReader reader(std::move(one), open(), options, false);
      disagreements.push_back(disagreement_with_odometry(reader));
    }
    const OdometryDisagreement least =
        *std::min_element(disagreements.begin(), disagreements.end(),
                          [](const auto& a, const auto& b) { return a.median_m < b.median_m; });
    const auto is_worse = [&](const auto& one) { return least.is_clearly_less_than(one); };
    const auto best = std::find_if_not(disagreements.begin(), disagreements.end(), is_worse);
    const bool is_clear =
        disagreements.size() == rivals.size() && std::all_of(best + 1, disagreements.end(), is_worse);
    const std::string& chosen = rivals.at(static_cast<std::size_t>(best - disagreements.begin()));
    std::replace(plan.scan_topics.begin(), plan.scan_topics.end(), rivals.front(), chosen);
    std::vector<std::string> others = rivals;
    others.erase(std::find(others.begin(), others.end(), chosen));
    plan.assumptions.push_back("the scans of " + name_list(others) + " are not used, because " + chosen +
                               " has scans of the same laser" +
                               (is_clear ? ", which agree better with odometry" : "") +
                               ". Select topics with log.scan_topic");
  }
  return plan;
}

}  // namespace

std::unique_ptr<LogReader> open_bag_log(const std::filesystem::path& path, const LogOptions& options) {
  BagPlan plan = with_agreeing_topics(plan_bag(open_bag(path), path, options, kUsualLookOver_s), options,
                                      [&] { return open_bag(path); });
  return std::make_unique<RosbagReader>(std::move(plan), open_bag(path), options, false);
}

std::unique_ptr<BagFile> follow_record_bag(std::unique_ptr<ByteSource> recording) {
  const std::filesystem::path path = recording->path();
  auto first = std::make_shared<std::string>(1, '\0');
  first->resize(recording->read(first->data(), 1));
  if (first->empty()) return nullptr;
  const bool is_ros1 = *first == "#";
  auto bytes = std::make_unique<TextSource>(first, path, std::move(recording));
  return is_ros1 ? follow_ros1_bag(std::move(bytes)) : follow_mcap_bag(std::move(bytes));
}

std::unique_ptr<LogReader> open_followed_bag(std::unique_ptr<BagRecording> recording,
                                             const LogOptions& options, double look_over_s) {
  const auto beginning =
      std::make_shared<const BeginningOfBag>(read_beginning(*recording->bag, options, look_over_s));
  BagPlan plan = with_agreeing_topics(plan_bag(begun_bag(beginning), recording->path, options, look_over_s),
                                      options, [&] { return begun_bag(beginning); });
  if (recording->planned) recording->planned(plan);
  return std::make_unique<RosbagReader>(std::move(plan), begun_bag(beginning, std::move(recording->bag)),
                                        options, true);
}

std::unique_ptr<LogReader> open_rosbag_stream(std::unique_ptr<ByteSource> recording,
                                              const LogOptions& options, double look_over_s) {
  BagRecording followed;
  followed.path = recording->path();
  followed.bag = follow_record_bag(std::move(recording));
  if (!followed.bag)
    throw UserError(
        followed.path.string() +
        " is empty: its recorder has written nothing yet. Start the recorder, and follow it again");
  return open_followed_bag(std::make_unique<BagRecording>(std::move(followed)), options, look_over_s);
}

}  // namespace psi_slam
