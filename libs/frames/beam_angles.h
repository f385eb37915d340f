// SPDX-License-Identifier: BSD-3-Clause
// Bearings of beams for logs that do not state them. FLASER lines of CARMEN carry only a number of beams, and
// public readers disagree about half of the numbers. An error of one degree bends every turn of the map, so
// the user chooses the convention. `psi-slam check` measures which one fits: see beam_angle_study.h.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "psi_slam/log_options.h"

namespace psi_slam {

/// All conventions except kAuto.
const std::vector<BeamAngles>& stated_beam_angles();

/// Name in configuration files: "auto", "centred_step_inclusive", "centred_half_step", "left_open",
/// "skip_zero".
std::string_view name_of(BeamAngles angles);
std::optional<BeamAngles> beam_angles_named(std::string_view name);

/// Usual field of view for a number of beams, radians. 180, 181, 360 and 361 beams: 180 degrees; 540 and 541:
/// 270 degrees; 682, 683 and 769: steps of 360/1024 degrees. Nothing for other numbers.
std::optional<double> usual_field_of_view_rad(std::size_t beams);

/// Convention that kAuto selects if the log states no angles. 180, 360 and 540 beams: kLeftOpen, since one
/// more beam would span the field of view in whole or half degrees. Other numbers: kCentredStepInclusive.
BeamAngles usual_beam_angles(std::size_t beams);

/// Returns one bearing for each beam, radians. Requires beams > 0 and a field of view in (0, 2 pi]. Throws
/// UserError for kSkipZero with an odd number of beams.
std::vector<float> make_bearings_rad(BeamAngles angles, std::size_t beams, double field_of_view_rad);

}  // namespace psi_slam
