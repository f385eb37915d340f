// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/laser_readings.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/portable_math.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

const double kMaxTilt_rad = mrpt::DEG2RAD(15.0);
constexpr std::size_t kMaxBeams = 100'000;
constexpr double kMaxBearing_rad = 4 * M_PI;
constexpr double kMaxMount_m = 100;
constexpr double kLargestRange_m = 1000;  // no 2D laser sees farther

/// Angle between the laser's plane and the floor, in [0, pi/2].
double tilt_rad(const mrpt::math::CMatrixDouble33& rotation) {
  return portable::acos(std::min(1.0, std::abs(rotation(2, 2))));
}

}  // namespace

const std::vector<BeamAngles>& stated_beam_angles() {
  static const std::vector<BeamAngles> all{BeamAngles::kCentredStepInclusive, BeamAngles::kCentredHalfStep,
                                           BeamAngles::kLeftOpen, BeamAngles::kSkipZero};
  return all;
}

std::string_view name_of(BeamAngles angles) {
  constexpr std::array<std::string_view, 5> kNames{"auto", "centred_step_inclusive", "centred_half_step",
                                                   "left_open", "skip_zero"};
  return kNames.at(static_cast<std::size_t>(angles));
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
  const bool lacks_the_last_beam = beams == 180 || beams == 360 || beams == 540;
  return lacks_the_last_beam ? BeamAngles::kLeftOpen : BeamAngles::kCentredStepInclusive;
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

std::optional<EvenBearings> bearings_of_whole_degrees(float first_rad, double step_rad, std::size_t beams) {
  if (beams < 2 || !(step_rad > 0)) return std::nullopt;
  for (const BeamAngles angles :
       {BeamAngles::kCentredStepInclusive, BeamAngles::kCentredHalfStep, BeamAngles::kLeftOpen}) {
    const auto steps = static_cast<double>(angles == BeamAngles::kCentredStepInclusive ? beams - 1 : beams);
    const double field_of_view_rad = std::round(step_rad * steps * 180 / M_PI) * M_PI / 180;
    EvenBearings even{field_of_view_rad / steps, make_bearings_rad(angles, beams, field_of_view_rad)};
    const float stated_rad = static_cast<float>(step_rad);
    const float true_rad = static_cast<float>(even.step_rad);
    const bool has_step = std::abs(true_rad - stated_rad) <= std::nextafter(stated_rad, 10.0F) - stated_rad;
    if (has_step && even.bearings_rad.front() == first_rad) return even;
  }
  return std::nullopt;
}

std::optional<std::string> fault_of_beams(std::size_t beams, double first_rad, double step_rad) {
  std::ostringstream fault;
  if (beams > kMaxBeams) {
    fault << "the scan has " << beams << " beams, expected at most " << kMaxBeams
          << ". Correct the laser's driver";
    return fault.str();
  }
  const double last_rad = first_rad + step_rad * static_cast<double>(beams > 0 ? beams - 1 : 0);
  if (std::abs(first_rad) <= kMaxBearing_rad && std::abs(last_rad) <= kMaxBearing_rad) return std::nullopt;
  fault << "the bearings of the beams run from " << first_rad << " to " << last_rad
        << " radians, expected at most two turns. Correct the laser's driver, which may state degrees";
  return fault.str();
}

bool is_possible_mount(const TPose2D& robot_T_laser) {
  return std::abs(robot_T_laser.x) <= kMaxMount_m && std::abs(robot_T_laser.y) <= kMaxMount_m &&
         std::isfinite(robot_T_laser.phi);
}

FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place) {
  const mrpt::math::CMatrixDouble33 rotation = robot_T_laser.getRotationMatrix();
  const TPose2D mount{robot_T_laser.x(), robot_T_laser.y(), portable::atan2(rotation(1, 0), rotation(0, 0))};
  if (!is_possible_mount(mount) || !std::isfinite(rotation(2, 2)))
    throw UserError(place + ": the pose of the laser on the robot is " + mount.asString() +
                    ", expected finite numbers and at most 100 m. Select another laser with log.laser");
  if (tilt_rad(rotation) > kMaxTilt_rad)
    throw UserError(place + ": the laser is tilted by " +
                    std::to_string(std::lround(mrpt::RAD2DEG(tilt_rad(rotation)))) +
                    " degrees, expected at most 15. Select another laser with log.laser");
  return {mount, rotation(2, 2) < 0};
}

void mirror(std::vector<float>& bearings_rad) {
  for (float& bearing : bearings_rad) bearing = -bearing;
}

void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m) {
  // Both sides of the comparison have single precision: a reading written as "50.00" must equal a maximum of
  // 50.00.
  const auto min_range = static_cast<float>(min_range_m);
  const auto max_range = static_cast<float>(max_range_m);
  for (float& range : ranges_m) {
    const bool is_valid = range > 0 && range >= min_range;
    if (!is_valid)
      range = std::numeric_limits<float>::quiet_NaN();
    else if (range >= max_range)
      range = std::numeric_limits<float>::infinity();
  }
}

void limit_ranges(LaserScan& scan, const LogOptions& options, double stated_max_range_m,
                  double stated_min_range_m) {
  const double max_range_m = std::min(options.max_range_m.value_or(stated_max_range_m), kLargestRange_m);
  scan.max_range_m = static_cast<float>(max_range_m);
  mark_no_returns(scan.ranges_m, std::max(options.min_range_m, stated_min_range_m),
                  max_range_m > 0 ? max_range_m : kLargestRange_m);
}

}  // namespace psi_slam
