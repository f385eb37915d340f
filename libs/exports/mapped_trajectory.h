// SPDX-License-Identifier: BSD-3-Clause
// The robot's path in a finished map.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/mapping_result.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

/// Returns the robot pose in the map for each frame, in the order of the log, with its time.
inline Trajectory trajectory_of(const std::vector<FrameRecord>& frames) {
  Trajectory trajectory;
  trajectory.reserve(frames.size());
  for (const FrameRecord& frame : frames) trajectory.push_back({frame.time_us, frame.map_T_robot});
  return trajectory;
}

/// Returns trajectory_of() the frames of each run.
inline std::vector<Trajectory> trajectories_of_runs(const MappingResult& result) {
  const Trajectory whole = trajectory_of(result.frames);
  const auto at = [&](std::size_t i) { return whole.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<Trajectory> trajectories;
  for (const FrameSpan& run : runs_of(result)) trajectories.emplace_back(at(run.begin), at(run.end));
  return trajectories;
}

/// Returns the robot pose in the map for each frame, in the order of the log.
inline std::vector<mrpt::math::TPose2D> mapped_poses(const MappingResult& result) {
  std::vector<mrpt::math::TPose2D> poses;
  poses.reserve(result.frames.size());
  for (const FrameRecord& frame : result.frames) poses.push_back(frame.map_T_robot);
  return poses;
}

/// Returns mapped_poses() of each run.
inline std::vector<std::vector<mrpt::math::TPose2D>> paths_of_runs(const MappingResult& result) {
  const std::vector<mrpt::math::TPose2D> poses = mapped_poses(result);
  const auto at = [&](std::size_t i) { return poses.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<std::vector<mrpt::math::TPose2D>> paths;
  for (const FrameSpan& run : runs_of(result)) paths.emplace_back(at(run.begin), at(run.end));
  return paths;
}

}  // namespace psi_slam
