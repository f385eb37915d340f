// SPDX-License-Identifier: BSD-3-Clause
// Path segments whose motion is doubtful: scans that matched no local map, places where the robot was lost,
// and gaps of the log. They are suspects of faults in the map.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Stretch of frames, both ends included, across which the motion of the robot is doubtful.
struct PathSuspect {
  enum class Kind {
    kUnmatched,  ///< odometry or the constant-velocity model placed the scans
    kLost,       ///< an interruption at which the place of the robot was lost, and found again
    kUnplaced,   ///< an interruption after which the place of the robot was never found
    kGap,        ///< a gap of the log after which the robot seemed to be where it was expected
  };
  Kind kind = Kind::kUnmatched;
  std::size_t first_frame = 0;
  std::size_t last_frame = 0;
  double doubt_m = 0;  ///< motion of the robot that no match confirms; turns count with a lever of 1 m
};

/// Returns the suspects in the order of the log. A gap lasts at least 2 s and ten times the median time
/// between scans; it is between the frame before first_frame and first_frame. Leaves out stretches in which
/// the robot moved by less than `min_doubt_m`.
std::vector<PathSuspect> path_suspects(const MappingResult& result, double min_doubt_m = 0.3);

}  // namespace psi_slam
