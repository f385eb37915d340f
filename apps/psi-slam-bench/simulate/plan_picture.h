// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "trajectory/trajectory_file.h"
#include "simulation/floor_plan.h"

namespace psi_slam {

/// The floor plan with the robot's true path in it, SVG.
std::string plan_svg(const FloorPlan& plan, const Trajectory& truth);

}  // namespace psi_slam
