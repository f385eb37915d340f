// SPDX-License-Identifier: BSD-3-Clause
#include "exports/mapped_trajectory.h"

namespace psi_slam {

Trajectory trajectory_of(const std::vector<FrameRecord>& frames) {
  Trajectory trajectory;
  trajectory.reserve(frames.size());
  for (const FrameRecord& frame : frames) trajectory.push_back({frame.time_us, frame.map_T_robot});
  return trajectory;
}

}  // namespace psi_slam
