// SPDX-License-Identifier: BSD-3-Clause
// Does odometry say what the scans say? Judged without presuming that it does: scans are followed from one to
// the next by themselves, and only then compared with odometry.
#pragma once

#include <cstddef>
#include <vector>

#include "doctor/log_facts.h"
#include "doctor/scan_sampling.h"

namespace psi_slam {

/// How the turns of odometry relate to those of the scans.
enum class HeadingRelation {
  kUnknown,   ///< too few turns seen
  kAgrees,    ///
  kOpposite,  ///< odometry turns left where the scans turn right
  kDegrees,   ///< odometry's headings are degrees where radians are expected
  kOppositeDegrees,
  kNone,  ///< odometry does not turn where the scans do
  kUnrelated,
};

struct OdometryAgreement {
  std::size_t tracks = 0;          ///< stretches that could be followed by scans
  double scan_path_m = 0;          ///< motion in them by scans, and
  double odometry_path_m = 0;      ///< by odometry
  std::size_t length_samples = 0;  ///< stretches with translation that the scans determine
  double length_ratio = 0;         ///< odometry by scans, their median; 0 when unknown
  double length_ratio_low = 0;     ///< quartiles
  double length_ratio_high = 0;
  std::size_t turn_samples = 0;
  HeadingRelation heading = HeadingRelation::kUnknown;
  double heading_share =
      0;  ///< of the turns that fit this relation; for degrees, how well they do, in [0, 1]
  /// Direction of motion by scans minus that by odometry, both on the robot: where odometry puts the laser's
  /// heading wrongly. With its concentration, in [0, 1].
  double direction_offset_rad = 0;
  double direction_concentration = 0;
  /// Median angle between odometry's motion and the robot's axis, in [0, pi/2]: large when odometry's
  /// headings do not belong to its positions.
  double odometry_slip_rad = 0;
};

/// The stretches to follow, from each start on; `library` must hold these frames.
std::vector<std::vector<std::size_t>> tracks_from(const std::vector<std::size_t>& starts,
                                                  std::size_t frames_in_log);

OdometryAgreement check_odometry(const std::vector<FrameMark>& marks,
                                 const std::vector<std::vector<std::size_t>>& tracks,
                                 const ScanLibrary& library);

}  // namespace psi_slam
