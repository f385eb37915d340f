// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "doctor/scan_alignment.h"
#include "doctor/scan_sampling.h"

namespace psi_slam {

/// The motion between two frames by odometry and by their scans.
struct AlignedPair {
  FramePair frames;
  mrpt::math::TPose2D by_odometry;
  ScanAlignment by_scans;  ///< found from odometry's motion
};

/// Whether the alignment can be relied on: most points matched, and close.
bool is_reliable(const ScanAlignment& alignment);

/// All pairs, those that could not be aligned reliably too.
std::vector<AlignedPair> align_pairs(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                     const ScanLibrary& library);

// ---- What the aligned pairs of a log show ----

/// Odometry that counts reversing as driving ahead: the scans went back by about as much as odometry went
/// ahead.
struct LostReversals {
  std::size_t pairs_checked = 0;  ///< with enough motion that the scans determine
  double checked_m = 0;           ///< their way by odometry
  std::vector<FramePair> pairs;   ///< that the scans say were driven backwards
  double reversed_m = 0;          ///< their way by scans
};

/// Aligns every moving pair once more from the opposite motion; a pair counts when that fits clearly better.
LostReversals find_lost_reversals(const std::vector<AlignedPair>& pairs, const ScanLibrary& library);

/// The pose of the laser on the robot that best explains how scans and odometry moved together (hand-eye
/// calibration). Beside the pose it says by how much odometry overstates distances.
struct LaserMountEstimate {
  std::size_t pairs = 0;
  mrpt::math::TPose2D robot_T_laser;
  double deviation_m = 0;       ///< standard deviation of x, and of y
  double deviation_rad = 0;     ///< of the heading
  double odometry_scale = 1.0;  ///< distance by odometry / by scans
};

/// None with too few pairs that turn and too few that drive. `stated_mount` is the one the scans were aligned
/// with.
std::optional<LaserMountEstimate> estimate_laser_mount(const std::vector<AlignedPair>& pairs,
                                                       const mrpt::math::TPose2D& stated_mount);

}  // namespace psi_slam
