// SPDX-License-Identifier: BSD-3-Clause
// Finds where a run begins in the finished map of other runs. The localizer finds the robot in the map and
// follows it until its pose is certain. The front end's estimate of the motion leads from that pose back to
// the run's first scan.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <atomic>
#include <optional>

#include "base/share_observer.h"
#include "psi_slam/mapping_result.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

/// Returns where the run begins in the map. `grid` is the map of `mapped`; `map_T_start` is roughly the pose
/// of the robot at the beginning of the run, if it is known. Calls `progress` after each scan with the share
/// of the run that was read, in [0, 1]. Reads only as many scans as needed. Throws UserError if the run fits
/// nowhere or in several places, and SystemFailure if `stop` became true.
RunStart place_run(const MappingResult& mapped, const mrpt::maps::COccupancyGridMap2D& grid,
                   const SessionInput& run, const Settings& settings,
                   const std::optional<mrpt::math::TPose2D>& map_T_start, const std::atomic<bool>& stop,
                   const ShareObserver& progress = {});

}  // namespace psi_slam
