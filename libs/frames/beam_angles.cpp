// SPDX-License-Identifier: BSD-3-Clause
#include "frames/beam_angles.h"

#include <mrpt/core/bits_math.h>

#include <array>
#include <string>
#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::array<std::pair<BeamAngles, std::string_view>, 5> kNames{{
    {BeamAngles::kAuto, "auto"},
    {BeamAngles::kCentredStepInclusive, "centred_step_inclusive"},
    {BeamAngles::kCentredHalfStep, "centred_half_step"},
    {BeamAngles::kLeftOpen, "left_open"},
    {BeamAngles::kSkipZero, "skip_zero"},
}};

bool lacks_the_last_beam(std::size_t beams) {
  return beams == 180 || beams == 360 || beams == 540;
}

}  // namespace

const std::vector<BeamAngles>& stated_beam_angles() {
  static const std::vector<BeamAngles> all{BeamAngles::kCentredStepInclusive, BeamAngles::kCentredHalfStep,
                                           BeamAngles::kLeftOpen, BeamAngles::kSkipZero};
  return all;
}

std::string_view name_of(BeamAngles angles) {
  for (const auto& [value, name] : kNames)
    if (value == angles) return name;
  return "auto";
}

std::optional<BeamAngles> beam_angles_named(std::string_view name) {
  for (const auto& [value, known_name] : kNames)
    if (known_name == name) return value;
  return std::nullopt;
}

std::optional<double> usual_field_of_view_rad(std::size_t beams) {
  switch (beams) {
    case 180:
    case 181:
    case 360:
    case 361:
      return mrpt::DEG2RAD(180.0);
    case 540:
    case 541:
      return mrpt::DEG2RAD(270.0);
    case 682:
    case 683:
    case 769:
      return mrpt::DEG2RAD(static_cast<double>(beams - 1) * 360.0 / 1024.0);
    default:
      return std::nullopt;
  }
}

BeamAngles usual_beam_angles(std::size_t beams) {
  return lacks_the_last_beam(beams) ? BeamAngles::kLeftOpen : BeamAngles::kCentredStepInclusive;
}

std::vector<float> make_bearings_rad(BeamAngles angles, std::size_t beams, double field_of_view_rad) {
  if (angles == BeamAngles::kAuto) angles = usual_beam_angles(beams);
  if (angles == BeamAngles::kSkipZero && beams % 2 != 0) {
    throw UserError("log.beam_angles is skip_zero, which needs an even number of beams, but the scans have " +
                    std::to_string(beams) + ". Choose another convention");
  }
  const bool inclusive = angles == BeamAngles::kCentredStepInclusive;
  const double steps = static_cast<double>(inclusive ? beams - 1 : beams);
  const double step_rad = steps > 0 ? field_of_view_rad / steps : 0;
  double first_rad = beams > 1 ? -field_of_view_rad / 2 : 0;
  if (angles == BeamAngles::kCentredHalfStep && beams > 1) first_rad += step_rad / 2;
  std::vector<float> bearings_rad(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const std::size_t skipped = angles == BeamAngles::kSkipZero && i >= beams / 2 ? 1 : 0;
    bearings_rad[i] = static_cast<float>(first_rad + static_cast<double>(i + skipped) * step_rad);
  }
  return bearings_rad;
}

}  // namespace psi_slam
