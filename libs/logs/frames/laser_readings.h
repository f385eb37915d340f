// SPDX-License-Identifier: BSD-3-Clause
// Steps that the readers of all formats share when they turn a message of a laser into a LaserScan.
//
// Some logs do not state the bearings of the beams: FLASER lines of CARMEN state only the number of beams.
// For about half of the usual numbers of beams, public readers disagree on the bearings. An error of one
// degree bends the map at every turn. The user therefore chooses the convention, and `psi-slam check`
// measures which one fits: see beam_angle_study.h.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// All conventions of beam angles except kAuto.
const std::vector<BeamAngles>& stated_beam_angles();

/// Name of a convention in settings files: "auto", "centred_step_inclusive", "centred_half_step",
/// "left_open", "skip_zero".
std::string_view name_of(BeamAngles angles);

/// Usual field of view for a number of beams, radians. 180, 181, 360 and 361 beams: 180 degrees; 540 and 541:
/// 270 degrees; 682, 683 and 769: steps of 360/1024 degrees. Empty for other numbers.
std::optional<double> usual_field_of_view_rad(std::size_t beams);

/// Convention that kAuto selects if the log states no angles. 180, 360 and 540 beams: kLeftOpen, since one
/// more beam would span the field of view in whole or half degrees. Other numbers: kCentredStepInclusive.
BeamAngles usual_beam_angles(std::size_t beams);

/// Returns one bearing for each beam, radians. Requires beams > 0 and a field of view in (0, 2 pi]. Throws
/// UserError for kSkipZero with an odd number of beams.
std::vector<float> make_bearings_rad(BeamAngles angles, std::size_t beams, double field_of_view_rad);

/// Bearings at equal steps, radians.
struct EvenBearings {
  double step_rad = 0;
  std::vector<float> bearings_rad;
};

/// Returns the bearings of make_bearings_rad() whose first bearing and step are these numbers, up to the last
/// bit of a 32-bit float of the step, for a field of view of a whole number of degrees. So a laser has the
/// same bearings in a format that states floats and in one that states degrees. Empty if no convention has
/// these numbers.
std::optional<EvenBearings> bearings_of_whole_degrees(float first_rad, double step_rad, std::size_t beams);

/// Returns what is wrong with the beams of a scan, as a part of a sentence. `step_rad` is the angle from each
/// beam to the next. Returns nothing for up to 100,000 beams with bearings within two turns of straight
/// ahead.
std::optional<std::string> fault_of_beams(std::size_t beams, double first_rad, double step_rad);

/// Returns whether a laser can be mounted at this pose: its numbers are finite, and it is at most 100 m from
/// the robot's centre along each axis.
bool is_possible_mount(const mrpt::math::TPose2D& robot_T_laser);

/// Pose of a laser on the robot, projected to the floor.
struct FloorMount {
  mrpt::math::TPose2D robot_T_laser;
  bool upside_down = false;  ///< seen from above, the laser counts its beams in the opposite direction
};

/// Projects the pose of a laser to the floor. Throws UserError that starts with `place` if the laser is
/// tilted by more than 15 degrees, or if its mount is not possible, see is_possible_mount().
FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place);

/// Reverses the sign of all bearings.
void mirror(std::vector<float>& bearings_rad);

/// Replaces ranges, metres, that are no returns: by infinity at or beyond `max_range_m`; by NaN if they are
/// zero, negative, below `min_range_m` or not a number.
void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m);

/// Sets the maximum range of a scan and marks its readings without a return. The user's options override the
/// maximum that the log states; `stated_max_range_m` is 0 if the log states none. If neither states a
/// maximum, the maximum range of the scan stays 0, and MaxRangeSource later determines it from the readings.
/// The minimum range is the larger of `stated_min_range_m` and that in `options`. Readings of 1 km or more
/// are always no returns.
void limit_ranges(LaserScan& scan, const LogOptions& options, double stated_max_range_m,
                  double stated_min_range_m = 0);

}  // namespace psi_slam
