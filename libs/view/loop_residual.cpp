// SPDX-License-Identifier: BSD-3-Clause
#include "view/loop_residual.h"

#include <cmath>

#include "pose_graph/constraint_error.h"

namespace psi_slam {

LoopResidual loop_residual(const LoopRecord& loop, const std::vector<mrpt::math::TPose2D>& map_T_node) {
  const Eigen::Vector3d error = constraint_error(loop.anchor_T_node, RotatedPose(map_T_node.at(loop.anchor)),
                                                 RotatedPose(map_T_node.at(loop.node)));
  return {std::hypot(error.x(), error.y()), std::abs(error.z())};
}

}  // namespace psi_slam
