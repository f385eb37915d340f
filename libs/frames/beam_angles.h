// SPDX-License-Identifier: BSD-3-Clause
// The bearings of beams whose log does not state them. CARMEN's FLASER lines carry only a count, and public
// readers disagree about half of the counts; a wrong guess of one degree bends every turn, so the choice is
// the user's to make (and to measure: see beam_angle_study.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace psi_slam {

/// How n beams share a field of view F; bearings run counter-clockwise from the right.
enum class BeamAngles {
  kAuto,                  ///< what the log states, else `usual_beam_angles(n)`
  kCentredStepInclusive,  ///< -F/2 ... +F/2 in steps F/(n-1): a beam on either end
  kCentredHalfStep,       ///< -F/2 + s/2 ... +F/2 - s/2 in steps s = F/n (180 beams: -89.5 ... +89.5 degrees)
  kLeftOpen,              ///< -F/2 ... +F/2 - s in steps s = F/n (180 beams: -90 ... +89 degrees)
  kSkipZero,              ///< as kLeftOpen without the beam at 0 (180 beams: -90 ... -1, +1 ... +90 degrees)
};

/// All conventions but kAuto.
const std::vector<BeamAngles>& stated_beam_angles();

/// The name in configuration files: "auto", "centred_step_inclusive", "centred_half_step", "left_open",
/// "skip_zero".
std::string_view name_of(BeamAngles angles);
std::optional<BeamAngles> beam_angles_named(std::string_view name);

/// The field of view that this many beams usually span, radians: 180 and 181 beams, 360 and 361 beams: 180
/// degrees; 540 and 541: 270; 682, 683 and 769: steps of 360/1024 degrees. None for other counts.
std::optional<double> usual_field_of_view_rad(std::size_t beams);

/// What kAuto stands for when the log states no angles: kLeftOpen for 180, 360 and 540 beams, which lack one
/// beam to span their field of view in whole or half degrees; kCentredStepInclusive for every other count.
BeamAngles usual_beam_angles(std::size_t beams);

/// One bearing a beam, radians. Needs beams > 0 and a field of view in (0, 2 pi]; an odd count has no
/// kSkipZero: UserError.
std::vector<float> make_bearings_rad(BeamAngles angles, std::size_t beams, double field_of_view_rad);

}  // namespace psi_slam
