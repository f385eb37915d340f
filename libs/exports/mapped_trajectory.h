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

/// Returns the robot pose in the map for each frame, in the order of the log.
inline std::vector<mrpt::math::TPose2D> mapped_poses(const MappingResult& result) {
  std::vector<mrpt::math::TPose2D> poses;
  poses.reserve(result.frames.size());
  for (const FrameRecord& frame : result.frames) poses.push_back(frame.map_T_robot);
  return poses;
}

}  // namespace psi_slam
