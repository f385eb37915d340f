// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that write a simulated run as a rawlog of either form. The true pose of each scan is known.
#pragma once

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "logs/observations/mrpt_objects.h"
#include "map/trajectory/trajectory_file.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct SimulatedDriveWithTruth {
  std::vector<Frame> frames;
  std::map<TimeUs, mrpt::math::TPose2D> truth;  ///< true poses by time stamp, relative to the first scan

  explicit SimulatedDriveWithTruth(double path_m) {
    SimulatedLog log(simulated_log_options(path_m, 3));
    mrpt::math::TPose2D world_T_start;
    while (std::optional<Frame> frame = log.next()) {
      if (frames.empty()) world_T_start = log.world_T_robot();
      truth[frame->time_us] = log.world_T_robot() - world_T_start;
      frames.push_back(*std::move(frame));
    }
  }

  /// Mean distance of the positions from the true positions, in metres.
  double error_m(const Trajectory& path) const {
    double sum = 0;
    for (const StampedPose& pose : path) {
      const mrpt::math::TPose2D& there = truth.at(pose.time_us);
      sum += std::hypot(pose.pose.x - there.x, pose.pose.y - there.y);
    }
    return sum / static_cast<double>(path.size());
  }

  /// Mean position error of odometry alone, in metres.
  double odometry_error_m() const {
    Trajectory path;
    for (const Frame& frame : frames)
      path.push_back({frame.time_us, frame.odom_T_robot - frames.front().odom_T_robot});
    return error_m(path);
  }
};

/// The simulated run of 120 m, made once for all tests.
inline const SimulatedDriveWithTruth& simulated_drive() {
  static const SimulatedDriveWithTruth kDrive(120);
  return kDrive;
}

inline mrpt::obs::CObservationOdometry odometry_observation(const Frame& frame) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = mrpt_clock_time(frame.time_us);
  odometry.odometry = mrpt::poses::CPose2D(frame.odom_T_robot);
  return odometry;
}

/// Writes a rawlog. Form 1: actions and sensory frames. Form 2: single observations, each scan followed by
/// its odometry.
inline std::filesystem::path write_rawlog(const std::filesystem::path& path, const std::vector<Frame>& frames,
                                          int form) {
  mrpt::io::CFileOutputStream file(path.string());
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::math::TPose2D last = frames.front().odom_T_robot;
  for (const Frame& frame : frames) {
    if (form == 1) {
      mrpt::obs::CSensoryFrame observations;
      observations.insert(range_observation(frame));
      archive << robot_action(frame.odom_T_robot - last, frame.time_us) << observations;
    } else {
      archive << *range_observation(frame) << odometry_observation(frame);
    }
    last = frame.odom_T_robot;
  }
  return path;
}

/// Returns the frame with only the beams [begin, end).
inline Frame seen_by_part(const Frame& frame, std::size_t begin, std::size_t end) {
  Frame part = frame;
  const std::vector<float>& bearings = *frame.scan.bearings_rad;
  part.scan.bearings_rad =
      std::make_shared<const std::vector<float>>(bearings.begin() + static_cast<std::ptrdiff_t>(begin),
                                                 bearings.begin() + static_cast<std::ptrdiff_t>(end));
  part.scan.ranges_m.assign(frame.scan.ranges_m.begin() + static_cast<std::ptrdiff_t>(begin),
                            frame.scan.ranges_m.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

inline Frame seen_on_the_right(const Frame& frame) {
  return seen_by_part(frame, 0, frame.scan.ranges_m.size() / 2);
}

inline Frame seen_on_the_left(const Frame& frame) {
  return seen_by_part(frame, frame.scan.ranges_m.size() / 2, frame.scan.ranges_m.size());
}

/// Writes a rawlog like write_rawlog(), of a robot with one or two lasers, "right" and "left". Each laser has
/// half of the beams.
inline std::filesystem::path write_rawlog_of_lasers(const std::filesystem::path& path,
                                                    const std::vector<Frame>& frames, int form, bool right,
                                                    bool left) {
  mrpt::io::CFileOutputStream file(path.string());
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::math::TPose2D last = frames.front().odom_T_robot;
  for (const Frame& frame : frames) {
    std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;
    if (right) scans.push_back(range_observation(seen_on_the_right(frame)));
    if (right) scans.back()->sensorLabel = "right";
    if (left) scans.push_back(range_observation(seen_on_the_left(frame)));
    if (left) scans.back()->sensorLabel = "left";
    if (form == 1) {
      mrpt::obs::CSensoryFrame observations;
      for (const auto& scan : scans) observations.insert(scan);
      archive << robot_action(frame.odom_T_robot - last, frame.time_us) << observations;
    } else {
      for (const auto& scan : scans) archive << *scan;
      archive << odometry_observation(frame);
    }
    last = frame.odom_T_robot;
  }
  return path;
}

}  // namespace psi_slam
