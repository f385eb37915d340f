// SPDX-License-Identifier: BSD-3-Clause
// Where a drive begins in the finished map of others: its robot is set down in the map as `psi-slam localize`
// sets one down, lost or near a start that was told, and followed until it is sure where it is; from there
// its own way leads back to its first scan.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "psi_slam/mapping_result.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

/// `grid` is the map of `mapped`, `map_T_start` about where the robot begins in it. `tell` is told, scan by
/// scan, how much of the drive has been looked at, in [0, 1]; no more than it takes is. Throws UserError,
/// which says why, when the drive finds no place that it fits, or several; and SystemFailure when `stop`
/// became true.
RunStart place_run(const MappingResult& mapped, const mrpt::maps::COccupancyGridMap2D& grid,
                   const SessionInput& drive, const Settings& settings,
                   const std::optional<mrpt::math::TPose2D>& map_T_start, const std::atomic<bool>& stop,
                   const std::function<void(double share)>& tell = {});

}  // namespace psi_slam
