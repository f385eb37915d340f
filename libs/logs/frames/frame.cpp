// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/frame.h"

#include "logs/frames/pose_operations.h"

namespace psi_slam {

mrpt::math::TPose2D companion_pose(const CompanionScan& companion, const mrpt::math::TPose2D& map_T_robot) {
  return compose(map_T_robot, companion.frame_T_robot);
}

}  // namespace psi_slam
