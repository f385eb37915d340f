// SPDX-License-Identifier: BSD-3-Clause
// A loop that a person points out: something seen on one pass of the robot, and the same thing where it was
// seen on another. In a map that has drifted apart the two lie apart.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>

#include "psi_slam/loop_record.h"
#include "replay/replay_snapshot.h"

namespace psi_slam {

/// Half-widths of the window around what a person points at.
inline constexpr double kPointedAtWindow_m = 2.0;
inline constexpr double kPointedAtWindow_rad = 0.5;

/// The match of the newest scan taken near the first place with the local map of the oldest scan taken near
/// the second; where none was taken near, those taken nearest. The scan is looked for where it lies once the
/// first place is moved onto the second, its heading as it is. None where no finished local map is other than
/// the scan's own.
std::optional<LoopEdit> loop_between_places(const ReplaySnapshot& snapshot,
                                            const mrpt::math::TPoint2D& seen_by_scan,
                                            const mrpt::math::TPoint2D& in_local_map, MatcherKind matcher);

}  // namespace psi_slam
