// SPDX-License-Identifier: BSD-3-Clause
// Conversions between psi-slam's frames and MRPT's observations and actions, for MRPT's files and programs.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <optional>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Converts Unix time in microseconds, at most kMostTimeUs, to MRPT's clock.
mrpt::Clock::time_point mrpt_clock_time(TimeUs time_us);

/// Unix time of an observation, rounded to the nearest microsecond. Empty if the observation has no time
/// stamp or an impossible one, see kMostTimeUs.
std::optional<TimeUs> time_us(const mrpt::obs::CObservation& observation);

/// Movement of the robot relative to its previous pose: the increment of the odometry, or the mean of the
/// first other estimate if there is no odometry. Empty if no action is a movement of the robot.
std::optional<mrpt::math::TPose2D> movement_of(const mrpt::obs::CActionCollection& actions);

/// Returns the odometry increment `motion`, in the frame of the previous pose, as an action with MRPT's
/// default noise.
mrpt::obs::CActionCollection robot_action(const mrpt::math::TPose2D& motion, TimeUs time_us);

/// Returns the frame's first scan with evenly spread rays from the first to the last beam, as MRPT stores
/// scans. Uneven beams, such as GMapping's 180 beams without the one straight ahead, are assigned to finer
/// rays. Uses the minimum number of rays that represents each bearing to a milliradian, but at most four
/// times the number of beams. Rays without a beam and beams without a return are invalid. The sensor's pose
/// includes the mean bearing.
mrpt::obs::CObservation2DRangeScan::Ptr range_observation(const Frame& frame);

/// Returns the scans of all lasers of the frame, each with its own label and time stamp. Sensor poses are
/// relative to the robot's pose at the frame's time.
std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> range_observations(const Frame& frame);

}  // namespace psi_slam
