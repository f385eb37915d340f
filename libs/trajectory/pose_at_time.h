// SPDX-License-Identifier: BSD-3-Clause
// Where a trajectory is at times between its poses.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>

#include "psi_slam/time_stamp.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

struct PoseAtTime {
  mrpt::math::TPose2D pose;
  bool interpolated = false;
  std::size_t from = 0;  ///< the trajectory's pose that it is, or the one before it
};

/// A pose of the trajectory that is nearer than 0.1 ms to the time, else interpolated linearly, the angle
/// along the shorter arc. None where the trajectory, sorted by time, does not know: outside it and in longer
/// gaps.
std::optional<PoseAtTime> pose_at_time(const Trajectory& sorted, TimeUs time_us, TimeUs max_gap_us);

}  // namespace psi_slam
