// SPDX-License-Identifier: BSD-3-Clause
// The robot's path in a finished map.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "map/trajectory/trajectory_file.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns the robot pose in the map for each frame, in the order of the log, with its time.
inline Trajectory trajectory_of(const std::vector<FrameRecord>& frames) {
  Trajectory trajectory;
  trajectory.reserve(frames.size());
  for (const FrameRecord& frame : frames) trajectory.push_back({frame.time_us, frame.map_T_robot});
  return trajectory;
}

/// Splits a list with one element for each frame into one list for each run.
template <class Element>
std::vector<std::vector<Element>> split_by_runs(const std::vector<Element>& of_frames,
                                                const MappingResult& result) {
  const auto at = [&](std::size_t i) { return of_frames.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<std::vector<Element>> of_runs;
  for (const FrameSpan& run : runs_of(result)) of_runs.emplace_back(at(run.begin), at(run.end));
  return of_runs;
}

/// Returns trajectory_of() the frames of each run.
inline std::vector<Trajectory> trajectories_of_runs(const MappingResult& result) {
  return split_by_runs(trajectory_of(result.frames), result);
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
  return split_by_runs(mapped_poses(result), result);
}

}  // namespace psi_slam
