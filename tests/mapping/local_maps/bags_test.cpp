// SPDX-License-Identifier: BSD-3-Clause
// The front end on ROS bags of simulated robots: with a gyroscope, and with a lidar of many rings.
#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bag_files.h"
#include "log_files.h"
#include "mapping/local_maps/front_end.h"
#include "simulated_drive.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct PoseErrors {
  double largest_m = 0;
  double largest_rad = 0;
};

/// Follows the robot through a bag, and returns the errors of the poses.
PoseErrors errors_in(const Recording& bag, const std::vector<TPose2D>& map_T_robot,
                     const LogOptions& options) {
  const TemporaryFolder folder;
  write_mcap(folder.path() / "run.mcap", bag);
  FrontEnd front_end({});
  PoseErrors errors;
  const std::vector<Frame> frames = frames_of(folder.path() / "run.mcap", options);
  EXPECT_EQ(frames.size(), map_T_robot.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const TPose2D pose = front_end.add(frames[i]).local_T_robot;
    const TPose2D& truth = map_T_robot.at(i);
    errors.largest_m = std::max(errors.largest_m, std::hypot(pose.x - truth.x, pose.y - truth.y));
    errors.largest_rad = std::max(errors.largest_rad, std::abs(mrpt::math::wrapToPi(pose.phi - truth.phi)));
  }
  return errors;
}

RecordedScan recorded(const LaserScan& scan, TimeUs time_us) {
  RecordedScan message;
  message.time_us = time_us;
  message.angle_min_rad = scan.bearings_rad->front();
  message.angle_increment_rad = (*scan.bearings_rad)[1] - (*scan.bearings_rad)[0];
  message.ranges_m = scan.ranges_m;
  message.range_max_m = scan.max_range_m;
  return message;
}

constexpr TimeUs kStart_us = 1'600'000'000'000'000;
constexpr TimeUs kPeriod_us = 500'000;  // two scans per second

/// A robot in the middle of a square room that turns by 72 degrees between every third pair of scans. The
/// room looks nearly the same after a quarter turn.
SimulatedDrive turning_robot() {
  SimulatedWalls room;
  room.add_box(-4, -4, 4, 4);
  room.add_box(3.6, -1.5, 4, -0.7);
  room.add_box(-1.2, 3.7, -0.4, 4);
  std::vector<TPose2D> path;
  for (int i = 0; i < 45; ++i) path.emplace_back(0.02 * (i % 5), 0.02 * (i % 7), 0.4 * M_PI * (i / 3));
  return drive_along(room, path, {}, 21);
}

/// Records the scans of the robot, and the rates of an IMU at 100 Hz that hangs upside down. `measure`
/// returns the measurement of the true rate, radians per second.
template <class Measure>
Recording with_gyroscope(const SimulatedDrive& drive, Measure measure) {
  Recording bag{static_mount("laser", {0.1, 0, 0.3, 0, 0, 0}), static_mount("imu", {0, 0, 0, 0, 0, M_PI})};
  const std::size_t scans = drive.frames.size();
  for (std::size_t i = 0; i < scans; ++i) {
    const TimeUs time_us = kStart_us + static_cast<TimeUs>(i) * kPeriod_us;
    bag.emplace_back(recorded(drive.frames[i].scan, time_us));
    const TPose2D& next = drive.map_T_robot[std::min(i + 1, scans - 1)];
    const double turn_rad = mrpt::math::wrapToPi(next.phi - drive.map_T_robot[i].phi);
    for (TimeUs t = 5'000; t < kPeriod_us; t += 10'000)
      bag.emplace_back(
          RecordedImu{"/imu", time_us + t, "imu", {0, 0, -measure(turn_rad / seconds(kPeriod_us))}});
  }
  return bag;
}

TEST(FrontEndOnBags, a_gyroscope_keeps_the_heading_in_fast_turns_without_odometry) {
  const SimulatedDrive drive = turning_robot();
  constexpr double kBias_radps = 0.05;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  const Recording bag =
      with_gyroscope(drive, [&](double rate_radps) { return rate_radps + kBias_radps + noise(random); });
  LogOptions options;
  const PoseErrors with = errors_in(bag, drive.map_T_robot, options);
  EXPECT_LT(with.largest_m, 0.05);
  EXPECT_LT(with.largest_rad, 0.03);
  options.imu = "none";
  EXPECT_GT(errors_in(bag, drive.map_T_robot, options).largest_rad, 1) << "scans alone lose the heading";
}

// A way to and fro at 10 scans per second, which needs no gyroscope.
TEST(FrontEndOnBags, a_gyroscope_with_a_wrong_sign_unit_or_bias_does_no_harm) {
  SimulatedDrive drive =
      drive_along(office_floor(), path_along({{2, 1.5}, {6, 1.6}, {2, 1.4}}, 0.05, 0.3), {}, 5);
  const auto error_m = [&](auto measure) {
    FrontEnd front_end({});
    double largest_m = 0;
    double heading_rad = 0;
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
      Frame& frame = drive.frames[i];
      const TPose2D& truth = drive.map_T_robot[i];
      if (i > 0) heading_rad += measure(mrpt::math::wrapToPi(truth.phi - drive.map_T_robot[i - 1].phi));
      frame.has_odometry = false;
      frame.imu_heading_rad = heading_rad;
      const TPose2D pose = front_end.add(frame).local_T_robot;
      largest_m = std::max(largest_m, std::hypot(pose.x - truth.x, pose.y - truth.y));
    }
    return largest_m;
  };
  EXPECT_LT(error_m([](double turn_rad) { return turn_rad; }), 0.1);
  EXPECT_LT(error_m([](double turn_rad) { return -turn_rad; }), 0.1) << "its sign is wrong";
  EXPECT_LT(error_m([](double turn_rad) { return turn_rad * 180 / M_PI; }), 0.1) << "its unit is wrong";
  EXPECT_LT(error_m([](double turn_rad) { return turn_rad + 0.03; }), 0.1)
      << "a bias of 17 degrees per second";
}

/// Points of the walls, of the floor and of the ceiling that a lidar with 16 rings sees from 0.6 m above the
/// floor.
RecordedCloud simulated_cloud(const SimulatedWalls& walls, const TPose2D& world_T_lidar, TimeUs time_us) {
  constexpr double kLidarHeight_m = 0.6;
  constexpr double kCeiling_m = 2.4;
  RecordedCloud cloud;
  cloud.time_us = time_us;
  for (int ring = 0; ring < 16; ++ring) {
    const double rise = std::tan((2 * ring - 15) * M_PI / 180);
    for (int i = 0; i < 900; ++i) {
      const double bearing_rad = 2 * M_PI * i / 900;
      double range_m = walls.range_m(world_T_lidar, bearing_rad);
      const double to_floor_or_ceiling_m = (rise < 0 ? -kLidarHeight_m : kCeiling_m - kLidarHeight_m) / rise;
      range_m = std::min(range_m, to_floor_or_ceiling_m);
      cloud.points.push_back(
          {range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad), range_m * rise});
    }
  }
  return cloud;
}

TEST(FrontEndOnBags, a_slice_of_point_clouds_is_mapped_like_laser_scans) {
  const SimulatedWalls walls = office_floor();
  const TPose2D robot_T_lidar(0.1, 0, 0.5);
  const std::vector<TPose2D> path = path_along({{2, 1.5}, {17.5, 1.6}, {18.2, 6}}, 0.25, 0.25);
  Recording bag{static_mount("lidar", {0.1, 0, 0.6, 0.5, 0, 0})};
  std::vector<TPose2D> truth;
  for (const TPose2D& pose : path) {
    const TimeUs time_us = kStart_us + static_cast<TimeUs>(truth.size()) * 250'000;
    truth.push_back(pose - path.front());
    bag.emplace_back(simulated_cloud(walls, pose + robot_T_lidar, time_us));
  }
  LogOptions options;
  options.slice_z_m = "0.2 1.2";
  const PoseErrors errors = errors_in(bag, truth, options);
  EXPECT_LT(errors.largest_m, 0.1);
  EXPECT_LT(errors.largest_rad, 0.02);
}

}  // namespace
}  // namespace psi_slam
