// SPDX-License-Identifier: BSD-3-Clause
// What the objects of MRPT's rawlogs, or of a program that uses MRPT, say in our terms.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPosePDF.h>

#include <cstdint>
#include <optional>
#include <ratio>
#include <type_traits>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

static_assert(std::is_same_v<mrpt::Clock::period, std::ratio<1, 10'000'000>>,
              "MRPT counts tenths of microseconds, since 1601");
inline constexpr std::int64_t kMrptTicksFrom1601To1970 = 116'444'736'000'000'000;
inline constexpr std::int64_t kMrptTicksPerMicrosecond = 10;

inline mrpt::Clock::time_point mrpt_clock_time(TimeUs time_us) {
  return mrpt::Clock::time_point(
      mrpt::Clock::duration(time_us * kMrptTicksPerMicrosecond + kMrptTicksFrom1601To1970));
}

/// Unix time to the nearest microsecond. None when there is no time stamp.
inline std::optional<TimeUs> time_us(const mrpt::obs::CObservation& observation) {
  const std::int64_t ticks = observation.timestamp.time_since_epoch().count();
  if (ticks <= 0) return std::nullopt;
  const std::int64_t since_1970 = ticks - kMrptTicksFrom1601To1970;
  const std::int64_t half = since_1970 < 0 ? -kMrptTicksPerMicrosecond / 2 : kMrptTicksPerMicrosecond / 2;
  return (since_1970 + half) / kMrptTicksPerMicrosecond;
}

/// The increment of odometry; where the action is an estimate of another kind, its mean. None when no action
/// is a movement of the robot.
inline std::optional<mrpt::math::TPose2D> movement_of(const mrpt::obs::CActionCollection& actions) {
  std::optional<mrpt::math::TPose2D> estimate;
  for (const auto& action : actions) {
    const auto* movement = dynamic_cast<const mrpt::obs::CActionRobotMovement2D*>(action.get());
    if (movement == nullptr) continue;
    if (movement->estimationMethod == mrpt::obs::CActionRobotMovement2D::emOdometry)
      return movement->rawOdometryIncrementReading.asTPose();
    if (!estimate && movement->poseChange) estimate = movement->poseChange->getMeanVal().asTPose();
  }
  return estimate;
}

}  // namespace psi_slam
