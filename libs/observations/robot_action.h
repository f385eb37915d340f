// SPDX-License-Identifier: BSD-3-Clause
// Odometry as MRPT's own action, for its files and programs.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CActionCollection.h>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// A movement of the robot by odometry, with the noise that MRPT assumes where nobody says.
mrpt::obs::CActionCollection robot_action(const mrpt::math::TPose2D& motion, TimeUs time_us);

}  // namespace psi_slam
