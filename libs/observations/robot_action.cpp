// SPDX-License-Identifier: BSD-3-Clause
#include "observations/robot_action.h"

#include <mrpt/obs/CActionRobotMovement2D.h>

#include "observations/rawlog_objects.h"

namespace psi_slam {

mrpt::obs::CActionCollection robot_action(const mrpt::math::TPose2D& motion, TimeUs time_us) {
  mrpt::obs::CActionRobotMovement2D action;
  action.timestamp = mrpt_clock_time(time_us);  // icp-slam refuses one without
  action.computeFromOdometry(mrpt::poses::CPose2D(motion),
                             mrpt::obs::CActionRobotMovement2D::TMotionModelOptions());
  return mrpt::obs::CActionCollection(action);
}

}  // namespace psi_slam
