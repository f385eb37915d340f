// SPDX-License-Identifier: BSD-3-Clause
// Messages about frozen odometry: parts of a log where odometry stayed exactly the same although the robot
// moved. The front end predicts the motion there as without odometry.
#pragma once

#include <optional>
#include <string>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns sentences, the last one without full stop, about the stretches of two seconds or more with the
/// same odometry, to the last bit, along which the mapped robot moved 0.5 m or turned by 30 degrees: more
/// than scans of a robot at rest can err. They tell how long the stretches are, when the longest path was,
/// and what to do. Empty without such a stretch.
std::optional<std::string> frozen_odometry_text(const MappingResult& result);

}  // namespace psi_slam
