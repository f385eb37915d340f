// SPDX-License-Identifier: BSD-3-Clause
// Simulates a robot that drives along a curve through the furnished room. The robot has a front laser and a
// rear laser that is mounted upside down. Functions write its recording in every log format.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bag_files.h"
#include "logs/frames/odometry_interpolator.h"
#include "rawlog_files.h"
#include "simulated_run.h"
#include "test_files.h"

namespace psi_slam {

struct TwoLasers {
  mrpt::math::TPose2D robot_T_front{0.3, 0.05, 0};
  mrpt::math::TPose2D robot_T_rear{-0.4, -0.1, M_PI};
  TimeUs period_us = 100'000;
  TimeUs rear_later_us = 40'000;
  int scans = 20;
  TimeUs sweep_us = 0;  ///< time from a scan's first beam to its last
  /// Half-open intervals without scans of the front or rear laser, counted from kStart_us.
  TimeUs front_silent_from_us = 0, front_silent_to_us = 0;
  TimeUs rear_silent_from_us = 0, rear_silent_to_us = 0;

  static constexpr TimeUs kStart_us = 1'600'000'000'000'000;
  static constexpr double kHalfView_rad = M_PI / 2;
  static constexpr std::size_t kBeams = 181;

  /// True pose of the robot, which moves at 0.5 m/s and turns left at 1 rad/s.
  static mrpt::math::TPose2D world_T_robot(TimeUs time_us) {
    const double t = seconds(time_us - kStart_us);
    return {2 + 0.5 * std::sin(t), 6 + 0.5 * (1 - std::cos(t)), mrpt::math::wrapToPi(t)};
  }

  static std::vector<float> bearings_rad() {
    std::vector<float> bearings(kBeams);
    for (std::size_t i = 0; i < kBeams; ++i)
      bearings[i] = static_cast<float>(kHalfView_rad * (2.0 * static_cast<double>(i) / (kBeams - 1) - 1));
    return bearings;
  }

  struct Scan {
    bool rear = false;
    TimeUs time_us = 0;
    /// Ranges in the order of the beams. Seen from above, the beams of the rear laser are in clockwise order.
    std::vector<float> ranges_m;
  };

  Scan scan_at(TimeUs time_us, bool rear) const {
    static const std::vector<Wall> walls = furnished_room();
    Scan scan{rear, time_us, {}};
    const std::vector<float> bearings = bearings_rad();
    for (std::size_t i = 0; i < kBeams; ++i) {
      const auto bearing = static_cast<double>(rear ? -bearings[i] : bearings[i]);
      const TimeUs then_us = time_us + sweep_us * static_cast<TimeUs>(i) / static_cast<TimeUs>(kBeams - 1);
      const mrpt::math::TPose2D ray =
          world_T_robot(then_us) + (rear ? robot_T_rear : robot_T_front) + mrpt::math::TPose2D(0, 0, bearing);
      scan.ranges_m.push_back(static_cast<float>(range_m(walls, ray)));
    }
    return scan;
  }

  /// Scans of both lasers, ordered by time.
  std::vector<Scan> all_scans() const {
    std::vector<Scan> all;
    for (int i = 0; i < scans; ++i) {
      const TimeUs since_us = i * period_us;
      if (since_us < front_silent_from_us || since_us >= front_silent_to_us)
        all.push_back(scan_at(kStart_us + since_us, false));
      if (since_us < rear_silent_from_us || since_us >= rear_silent_to_us)
        all.push_back(scan_at(kStart_us + since_us + rear_later_us, true));
    }
    return all;
  }

  /// Calls `take(time, pose)` every 5 ms, from before the first scan to after the last.
  template <class Take>
  void for_each_odometry(Take take) const {
    for (TimeUs t = -5'000; t <= scans * period_us + 200'000; t += 5'000)
      take(kStart_us + t, world_T_robot(kStart_us + t));
  }
};

inline void write_rawlog_of(const std::filesystem::path& path, const TwoLasers& robot) {
  std::multimap<TimeUs, mrpt::serialization::CSerializable::Ptr> objects;
  robot.for_each_odometry([&](TimeUs time_us, const mrpt::math::TPose2D& pose) {
    objects.emplace(time_us, odometry(time_us, mrpt::poses::CPose2D(pose)));
  });
  for (const TwoLasers::Scan& scan : robot.all_scans()) {
    auto observation = range_scan(scan.time_us, scan.rear ? "REAR" : "FRONT", scan.ranges_m);
    observation->aperture = static_cast<float>(2 * TwoLasers::kHalfView_rad);
    const mrpt::math::TPose2D& mount = scan.rear ? robot.robot_T_rear : robot.robot_T_front;
    observation->sensorPose = mrpt::poses::CPose3D(mount.x, mount.y, 0.3, mount.phi, 0, scan.rear ? M_PI : 0);
    objects.emplace(scan.time_us, observation);
  }
  RawlogObjects in_order;
  for (const auto& [time_us, object] : objects) in_order.push_back(object);
  write_rawlog(path, in_order);
}

/// Writes FLASER and RLASER lines and optionally the mounts as PARAM lines. CARMEN cannot state that the rear
/// laser is upside down.
inline void write_carmen_of(const std::filesystem::path& path, const TwoLasers& robot, bool with_mounts) {
  std::string log;
  const auto number = [](double value) { return ' ' + std::to_string(value); };
  const auto exact = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, " %.9f", value);
    return std::string(text);
  };
  if (with_mounts) {
    for (const bool rear : {false, true}) {
      const mrpt::math::TPose2D& mount = rear ? robot.robot_T_rear : robot.robot_T_front;
      const std::string name = std::string("PARAM robot_") + (rear ? "rear" : "front") + "laser_";
      log += name + "offset" + exact(mount.x) + "\n" + name + "side_offset" + exact(mount.y) + "\n" + name +
             "angular_offset" + exact(mount.phi) + "\n";
    }
  }
  for (const TwoLasers::Scan& scan : robot.all_scans()) {
    log += (scan.rear ? "RLASER " : "FLASER ") + std::to_string(scan.ranges_m.size());
    for (const float range : scan.ranges_m) log += number(static_cast<double>(range));
    const mrpt::math::TPose2D pose = TwoLasers::world_T_robot(scan.time_us);
    for (int twice = 0; twice < 2; ++twice) log += exact(pose.x) + exact(pose.y) + exact(pose.phi);
    log += ' ' + format_seconds(scan.time_us) + " host 1\n";
  }
  write_file(path, log);
}

inline Recording recording_of(const TwoLasers& robot) {
  const auto pose_of = [](const mrpt::math::TPose2D& mount, double roll) {
    return mrpt::math::TPose3D(mount.x, mount.y, 0.3, mount.phi, 0, roll);
  };
  Recording recording{static_mount("front", pose_of(robot.robot_T_front, 0)),
                      static_mount("rear", pose_of(robot.robot_T_rear, M_PI))};
  std::multimap<TimeUs, Recorded> messages;
  robot.for_each_odometry([&](TimeUs time_us, const mrpt::math::TPose2D& pose) {
    messages.emplace(
        time_us, RecordedPose{"/odom", time_us, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}});
  });
  for (const TwoLasers::Scan& scan : robot.all_scans()) {
    RecordedScan message;
    message.topic = scan.rear ? "/rear/scan" : "/front/scan";
    message.frame = scan.rear ? "rear" : "front";
    message.time_us = scan.time_us;
    message.angle_min_rad = static_cast<float>(-TwoLasers::kHalfView_rad);
    message.angle_increment_rad = static_cast<float>(2 * TwoLasers::kHalfView_rad / (TwoLasers::kBeams - 1));
    message.ranges_m = scan.ranges_m;
    messages.emplace(scan.time_us, message);
  }
  for (const auto& [time_us, message] : messages) recording.push_back(message);
  return recording;
}

}  // namespace psi_slam
