// SPDX-License-Identifier: BSD-3-Clause
// Places where the building changed between two passes: walls, shelves or pallets that moved, came or went.
// The scans of such passes contradict each other, but not the poses of the map.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

#include "map/verdict/pass_checks.h"

namespace psi_slam {

struct SceneChange {
  mrpt::math::TPoint2D at;  ///< place in the map, metres
  double before_s = 0;      ///< time of the last scan that saw the scene before, since the first scan
  double after_s = 0;       ///< time of the first scan that saw the scene after the change
};

/// Returns the places of the checks that found a changed scene, the place of most checks first. Changes
/// within 2 m of each other are one. Leaves out those that fewer than `least_checks` found,
/// and those whose checks have no time of change in common.
std::vector<SceneChange> scene_changes(const MappingResult& result, const std::vector<MapView>& views,
                                       const std::vector<PassCheck>& checks, std::size_t least_checks);

/// Returns a clause: "the building changed at (3.1, -2.0) m between 1:20 and 1:45". Empty without changes.
std::string text_of(const std::vector<SceneChange>& changes);

}  // namespace psi_slam
