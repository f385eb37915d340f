// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/loop_record.h"

namespace psi_slam {

/// What the graph makes of a loop: how far the node lies from where the loop was matched.
struct LoopResidual {
  double distance_m = 0;
  double turn_rad = 0;  ///< without its sign
};

LoopResidual loop_residual(const LoopRecord& loop, const std::vector<mrpt::math::TPose2D>& map_T_node);

}  // namespace psi_slam
