// SPDX-License-Identifier: BSD-3-Clause
// What the objects of MRPT's rawlogs, or of a program that uses MRPT, say in our terms.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPosePDF.h>

#include <cstdint>
#include <optional>

#include "psi_slam/base/time_stamp.h"

namespace psi_slam {

/// Unix time to the nearest microsecond; MRPT counts tenths of it since 1601. None when there is no time
/// stamp.
inline std::optional<TimeUs> time_us(const mrpt::obs::CObservation& observation) {
  constexpr std::int64_t kTicksFrom1601To1970 = 116'444'736'000'000'000;
  constexpr std::int64_t kTicksPerMicrosecond = 10;
  const std::int64_t ticks = observation.timestamp.time_since_epoch().count();
  if (ticks <= 0) return std::nullopt;
  const std::int64_t since_1970 = ticks - kTicksFrom1601To1970;
  const std::int64_t half = since_1970 < 0 ? -kTicksPerMicrosecond / 2 : kTicksPerMicrosecond / 2;
  return (since_1970 + half) / kTicksPerMicrosecond;
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
