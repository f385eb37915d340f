// SPDX-License-Identifier: BSD-3-Clause
#include "logs/observations/mrpt_objects.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDF.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <ratio>
#include <string>
#include <type_traits>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservation2DRangeScan;

static_assert(std::is_same_v<mrpt::Clock::period, std::ratio<1, 10'000'000>>,
              "MRPT counts tenths of microseconds since 1601");
constexpr std::int64_t kTicksFrom1601To1970 = 116'444'736'000'000'000;
constexpr std::int64_t kTicksPerMicrosecond = 10;

struct EvenRays {
  std::size_t count = 0;
  std::vector<std::size_t> ray_of_beam;
};

/// Assigns each beam to the nearest of `count` evenly spaced rays from the first to the last bearing. Returns
/// nothing if a beam is farther than `tolerance_rad` from its ray; most unsuitable counts fail at one of the
/// first beams.
std::optional<EvenRays> spread(const std::vector<float>& bearings, std::size_t count, double tolerance_rad) {
  const auto first = static_cast<double>(bearings.front());
  const double step = (static_cast<double>(bearings.back()) - first) / static_cast<double>(count - 1);
  EvenRays rays{count, {}};
  for (const float bearing : bearings) {
    const double place =
        std::clamp((static_cast<double>(bearing) - first) / step, 0.0, static_cast<double>(count - 1));
    if (!(std::abs((place - std::round(place)) * step) < tolerance_rad)) return std::nullopt;
    rays.ray_of_beam.push_back(static_cast<std::size_t>(std::lround(place)));
  }
  return rays;
}

EvenRays even_rays(const std::vector<float>& bearings) {
  constexpr double kMeets_rad = 1e-3;
  constexpr std::size_t kFinest = 4;
  const std::size_t beams = bearings.size();
  if (beams < 2 || bearings.front() == bearings.back()) return {beams, std::vector<std::size_t>(beams, 0)};
  const std::size_t most = kFinest * (beams - 1) + 1;
  for (std::size_t count = beams; count < most; ++count)
    if (std::optional<EvenRays> rays = spread(bearings, count, kMeets_rad)) return *std::move(rays);
  return *spread(bearings, most, std::numeric_limits<double>::infinity());
}

CObservation2DRangeScan::Ptr observation_of(const LaserScan& scan, TimeUs time_us,
                                            const mrpt::math::TPose2D& robot_T_laser) {
  const std::vector<float>& bearings = *scan.bearings_rad;
  const EvenRays rays = even_rays(bearings);

  auto observation = CObservation2DRangeScan::Create();
  observation->timestamp = mrpt_clock_time(time_us);
  observation->sensorLabel = scan.laser == 0 ? "LASER" : "LASER" + std::to_string(scan.laser + 1);
  observation->maxRange = scan.max_range_m;
  observation->resizeScanAndAssign(rays.count, 0, false);
  float middle = 0;
  if (!bearings.empty()) {
    observation->aperture = std::abs(bearings.back() - bearings.front());
    observation->rightToLeft = bearings.back() >= bearings.front();
    middle = (bearings.front() + bearings.back()) / 2;
  }
  observation->sensorPose = mrpt::poses::CPose3D(compose(
      robot_T_laser, mrpt::math::TPose2D(0, 0, std::abs(middle) < 1e-6F ? 0 : static_cast<double>(middle))));
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const float range_m = scan.ranges_m[beam];
    if (std::isnan(range_m)) continue;
    observation->setScanRange(rays.ray_of_beam[beam], std::min(range_m, scan.max_range_m));
    observation->setScanRangeValidity(rays.ray_of_beam[beam], std::isfinite(range_m));
  }
  return observation;
}

}  // namespace

mrpt::Clock::time_point mrpt_clock_time(TimeUs time_us) {
  return mrpt::Clock::time_point(
      mrpt::Clock::duration(time_us * kTicksPerMicrosecond + kTicksFrom1601To1970));
}

std::optional<TimeUs> time_us(const mrpt::obs::CObservation& observation) {
  const std::int64_t ticks = observation.timestamp.time_since_epoch().count();
  if (ticks <= 0) return std::nullopt;
  const std::int64_t since_1970 = ticks - kTicksFrom1601To1970;
  const std::int64_t half = since_1970 < 0 ? -kTicksPerMicrosecond / 2 : kTicksPerMicrosecond / 2;
  const TimeUs time_us = (since_1970 + half) / kTicksPerMicrosecond;
  return is_possible_time(time_us) ? std::optional(time_us) : std::nullopt;
}

std::optional<mrpt::math::TPose2D> movement_of(const mrpt::obs::CActionCollection& actions) {
  std::optional<mrpt::math::TPose2D> estimate;
  for (const auto& action : actions) {
    const auto* movement = dynamic_cast<const CActionRobotMovement2D*>(action.get());
    if (movement == nullptr) continue;
    if (movement->estimationMethod == CActionRobotMovement2D::emOdometry)
      return movement->rawOdometryIncrementReading.asTPose();
    if (!estimate && movement->poseChange) estimate = movement->poseChange->getMeanVal().asTPose();
  }
  return estimate;
}

mrpt::obs::CActionCollection robot_action(const mrpt::math::TPose2D& motion, TimeUs time_us) {
  CActionRobotMovement2D action;
  action.timestamp = mrpt_clock_time(time_us);  // icp-slam rejects actions without a time stamp
  action.computeFromOdometry(mrpt::poses::CPose2D(motion), CActionRobotMovement2D::TMotionModelOptions());
  return mrpt::obs::CActionCollection(action);
}

CObservation2DRangeScan::Ptr range_observation(const Frame& frame) {
  return observation_of(frame.scan, frame.time_us, frame.scan.robot_T_laser);
}

std::vector<CObservation2DRangeScan::Ptr> range_observations(const Frame& frame) {
  std::vector<CObservation2DRangeScan::Ptr> observations{range_observation(frame)};
  for (const CompanionScan& companion : frame.companions)
    observations.push_back(observation_of(companion.scan, companion.time_us,
                                          compose(companion.frame_T_robot, companion.scan.robot_T_laser)));
  return observations;
}

}  // namespace psi_slam
