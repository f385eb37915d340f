// SPDX-License-Identifier: BSD-3-Clause
// Recording of a robot that swings to the left and to the right in the furnished room, with lasers that see
// all around and measure the beams of a scan one after the other.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bag_files.h"
#include "logs/frames/laser_readings.h"
#include "simulated_run.h"

namespace psi_slam {

/// A laser of the swinging robot.
struct SwingingLaser {
  std::string topic = "/scan";
  bool backward = false;  ///< the last beam is measured first
  double sweep_s = 0.15;  ///< time of a sweep; 0: all beams are measured at once
  double stated_sweep_s = 0.15;
};

/// Pose of the robot `time_s` after its start: it turns by up to 1 rad/s on the spot, at an angle that
/// never exceeds 60 degrees.
inline mrpt::math::TPose2D swinging_pose(double time_s, double rate_rad_s = 1) {
  return {2, 1.8, rate_rad_s * std::sin(time_s)};
}

/// Recording of 40 s: odometry every 20 ms, and a scan of each laser every 160 ms.
inline Recording swinging_robot(const std::vector<SwingingLaser>& lasers, double rate_rad_s = 1) {
  constexpr TimeUs kStart_us = 1'600'000'000'000'000;
  constexpr std::size_t kBeams = 360;
  const std::vector<Wall> walls = furnished_room();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  Recording recording;
  for (const SwingingLaser& laser : lasers)
    recording.emplace_back(static_mount("frame_of_" + laser.topic.substr(1), {0.1, 0, 0.3, 0, 0, 0}));
  for (TimeUs t = 0; t <= 40'000'000; t += 20'000) {
    const mrpt::math::TPose2D pose = swinging_pose(seconds(t), rate_rad_s);
    recording.emplace_back(
        RecordedPose{"/odom", kStart_us + t, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}});
    if (t % 160'000 != 0) continue;
    for (const SwingingLaser& laser : lasers) {
      RecordedScan scan;
      scan.topic = laser.topic;
      scan.time_us = kStart_us + t;
      scan.frame = "frame_of_" + laser.topic.substr(1);
      scan.angle_min_rad = static_cast<float>(-M_PI);
      scan.angle_increment_rad = static_cast<float>(2 * M_PI / kBeams);
      scan.time_increment_s = static_cast<float>(laser.stated_sweep_s / (kBeams - 1));
      scan.scan_time_s = 0.16F;
      scan.ranges_m.clear();
      for (std::size_t i = 0; i < kBeams; ++i) {
        const auto before = static_cast<double>(laser.backward ? kBeams - 1 - i : i) / (kBeams - 1);
        const double bearing_rad = -M_PI + 2 * M_PI * static_cast<double>(i) / kBeams;
        const mrpt::math::TPose2D ray = swinging_pose(seconds(t) + before * laser.sweep_s, rate_rad_s) +
                                        mrpt::math::TPose2D{0.1, 0, bearing_rad};
        scan.ranges_m.push_back(static_cast<float>(range_m(walls, ray) + noise(random)));
      }
      recording.emplace_back(scan);
    }
  }
  return recording;
}

}  // namespace psi_slam
