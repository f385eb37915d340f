// SPDX-License-Identifier: BSD-3-Clause
// Compares odometry with the scans without assuming that it is right: first aligns consecutive scans without
// odometry, then compares the resulting motion with odometry.
#pragma once

#include <cstddef>
#include <vector>

#include "doctor/log_facts.h"
#include "doctor/scan_sampling.h"

namespace psi_slam {

/// Relation of odometry's turns to those of the scans.
enum class HeadingRelation {
  kUnknown,          ///< too few turns
  kAgrees,           ///< equal turns
  kOpposite,         ///< odometry turns left where the scans turn right
  kDegrees,          ///< odometry's headings are in degrees instead of radians
  kOppositeDegrees,  ///< both of the above
  kNone,             ///< odometry does not turn where the scans do
  kUnrelated,
};

struct OdometryAgreement {
  std::size_t tracks = 0;          ///< tracks whose scans could be aligned
  double scan_path_m = 0;          ///< motion in all tracks by scans
  double odometry_path_m = 0;      ///< motion in all tracks by odometry
  std::size_t length_samples = 0;  ///< tracks with a translation that the scans determine
  double length_ratio = 0;         ///< median of odometry's length divided by the scans'; 0 if unknown
  std::size_t turn_samples = 0;
  HeadingRelation heading = HeadingRelation::kUnknown;
  double heading_share = 0;  ///< fraction of the turns with this relation; for degrees, its quality in [0, 1]
  /// Direction of motion by scans minus that by odometry, both relative to the robot: the error of the
  /// laser's stated heading. The concentration of the directions is in [0, 1].
  double direction_offset_rad = 0;
  double direction_concentration = 0;
  /// Median angle between odometry's motion and the robot's axis, in [0, pi/2]. Large if odometry's headings
  /// do not match its positions.
  double odometry_slip_rad = 0;
};

/// Returns the frames of the track from each start. The library of check_odometry() must hold them.
std::vector<std::vector<std::size_t>> tracks_from(const std::vector<std::size_t>& starts,
                                                  std::size_t frames_in_log);

OdometryAgreement check_odometry(const std::vector<FrameMark>& marks,
                                 const std::vector<std::vector<std::size_t>>& tracks,
                                 const ScanLibrary& library);

}  // namespace psi_slam
