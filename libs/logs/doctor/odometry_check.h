// SPDX-License-Identifier: BSD-3-Clause
// Compares odometry with the scans without assuming that odometry is right: first aligns consecutive scans
// without odometry, then compares the resulting motion with odometry.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "logs/doctor/log_facts.h"
#include "logs/doctor/scan_delay.h"
#include "logs/doctor/scan_sampling.h"

namespace psi_slam {

/// Relation of the turns by odometry to the turns by scans.
enum class HeadingRelation {
  kUnknown,          ///< too few turns
  kAgrees,           ///< equal turns
  kOpposite,         ///< odometry turns left where the scans turn right
  kDegrees,          ///< odometry's headings are in degrees instead of radians
  kOppositeDegrees,  ///< odometry's headings are in degrees and have the opposite sign
  kNone,             ///< odometry does not turn where the scans do
  kUnrelated,
};

struct OdometryAgreement {
  std::size_t tracks = 0;          ///< tracks whose scans could be aligned
  double scan_path_m = 0;          ///< sum of the displacements of all tracks, by scans
  double odometry_path_m = 0;      ///< sum of the displacements of all tracks, by odometry
  std::size_t length_samples = 0;  ///< tracks with a displacement that the scans determine
  double length_ratio = 0;  ///< median over tracks of displacement by odometry / by scans; 0 if unknown
  double length_share = 0;  ///< fraction of the tracks whose ratio is within 30 % of the median
  std::size_t turn_samples = 0;
  HeadingRelation heading = HeadingRelation::kUnknown;
  /// Fraction of turns with this relation; for kDegrees and kOppositeDegrees, quality of the match in [0, 1].
  double heading_share = 0;
  /// Mean direction of motion by scans minus direction by odometry, both in the frame of the robot. This
  /// difference is the error of the stated heading of the laser. The concentration is 1 if all tracks have
  /// the same difference, and about 0 if the differences are random.
  double direction_offset_rad = 0;
  double direction_concentration = 0;
  /// Median angle between the motion by odometry and the axis of the robot, in [0, pi/2]. The angle is large
  /// if the headings of odometry do not match the positions of odometry.
  double odometry_slip_rad = 0;
  std::vector<ScanTurn> turns{};  ///< turns between consecutive frames of all tracks
  /// Difference between the clocks of scans and odometry, if there is one. Odometry then agrees with the
  /// scans only after it is corrected. The other members describe odometry as recorded.
  std::optional<ScanDelay> clock_offset{};
};

/// Returns whether odometry moves along its own headings, forwards or backwards, as wheels do.
bool follows_its_heading(const OdometryAgreement& odometry);

/// Least angle between the directions of motion by scans and by odometry that wheels which slip do not
/// explain.
inline constexpr double kOtherDirection_rad = radians_from_degrees(15.0L);

/// Returns whether the scans move in another direction than odometry, the same along all tracks.
bool moves_in_another_direction(const OdometryAgreement& odometry);

/// Returns whether units and signs of odometry are right, as far as the scans tell.
bool is_sound(const OdometryAgreement& odometry);

/// Returns a track for each start: the indices of up to 15 consecutive frames. The library that is passed to
/// check_odometry() must hold these frames.
std::vector<std::vector<std::size_t>> tracks_from(const std::vector<std::size_t>& starts,
                                                  std::size_t frames_in_log);

OdometryAgreement check_odometry(const std::vector<FrameMark>& marks,
                                 const std::vector<std::vector<std::size_t>>& tracks,
                                 const ScanLibrary& library);

/// Like check_odometry(). If odometry is not sound, but is with scans that were measured before their time
/// stamps, also replaces the odometry of `marks` by that of the times of measurement. For more than a second
/// between both, sets OdometryAgreement::clock_offset instead.
OdometryAgreement check_odometry_and_delay(std::vector<FrameMark>& marks,
                                           const std::vector<std::vector<std::size_t>>& tracks,
                                           const ScanLibrary& library);

}  // namespace psi_slam
