// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/gyroscope_check.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>

#include "mapping/local_maps/gyroscope_model.h"

namespace psi_slam {
namespace {

constexpr std::size_t kFewestScans = 20;
constexpr double kMostRejected = 0.5;  // share of the scans
constexpr double kShortest_s = 1e-3;
constexpr double kLongest_s = 1.0;

/// Returns whether a scan and the one before it were matched shortly after each other, and a gyroscope
/// measured the turn between them.
bool tells(const MappingResult& result, std::size_t i) {
  const auto is_measured = [&](std::size_t scan) {
    return !result.log[scan].has_odometry && result.log[scan].imu_heading_rad &&
           result.frames[scan].match == ScanMatch::kMatched;
  };
  const double passed_s = seconds(result.frames[i].time_us - result.frames[i - 1].time_us);
  return is_measured(i - 1) && is_measured(i) && passed_s >= kShortest_s && passed_s <= kLongest_s;
}

}  // namespace

std::optional<std::string> rejected_gyroscope(const MappingResult& result, const FrameSpan& of_log) {
  GyroscopeModel model;
  double last_rate_radps = 0;  // 0: unknown
  std::size_t scans = 0;
  std::size_t rejected = 0;
  for (std::size_t i = of_log.begin + 1; i < of_log.end; ++i) {
    if (!tells(result, i)) {
      last_rate_radps = 0;
      continue;
    }
    const double passed_s = seconds(result.frames[i].time_us - result.frames[i - 1].time_us);
    const double measured_rad = *result.log[i].imu_heading_rad - *result.log[i - 1].imu_heading_rad;
    const double mapped_rad =
        mrpt::math::wrapToPi(result.frames[i].map_T_robot.phi - result.frames[i - 1].map_T_robot.phi);
    ++scans;
    if (!model.is_credible()) ++rejected;
    model.learn(passed_s, measured_rad, mapped_rad, last_rate_radps * passed_s);
    last_rate_radps = mapped_rad / passed_s;
  }
  const double share = scans < kFewestScans ? 0 : static_cast<double>(rejected) / static_cast<double>(scans);
  if (share <= kMostRejected) return std::nullopt;
  return "the gyroscope contradicts the scans in " + std::to_string(std::lround(100 * share)) + " % of the " +
         std::to_string(scans) +
         " scans that were compared. Remedy: correct the axis, sign or unit of its rates, or ignore it with "
         "log.imu=none";
}

}  // namespace psi_slam
