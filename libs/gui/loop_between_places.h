// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>

#include "gui/replay_snapshot.h"
#include "psi_slam/loop_record.h"

namespace psi_slam {

/// Half-widths of the search window around a place that a person clicked: along x and y, and in heading.
inline constexpr double kClickedWindow_m = 2.0;
inline constexpr double kClickedWindow_rad = 0.5;

/// Makes a loop from two clicks on one object that appears twice in a map with drift. Both places are in the
/// map's frame: `seen_by_scan` where later scans show the object, `in_local_map` where earlier scans show it.
/// The edit matches the newest scan near `seen_by_scan` with the local map of the oldest scan near
/// `in_local_map`. If no scan is near a place, takes the nearest scan. The search starts at the scan's pose,
/// shifted by the vector from `seen_by_scan` to `in_local_map`. Returns nothing unless there is a finished
/// local map that does not contain the scan.
std::optional<LoopEdit> loop_between_places(const ReplaySnapshot& snapshot,
                                            const mrpt::math::TPoint2D& seen_by_scan,
                                            const mrpt::math::TPoint2D& in_local_map, MatcherKind matcher);

}  // namespace psi_slam
