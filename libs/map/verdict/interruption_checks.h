// SPDX-License-Identifier: BSD-3-Clause
// Checks whether the robot was at the right place after an interruption or a gap of the log: its later scans
// must see the walls that it saw before.
#pragma once

#include <cstddef>
#include <vector>

#include "map/verdict/map_views.h"
#include "map/verdict/pass_checks.h"
#include "map/verdict/path_suspects.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct InterruptionCheck {
  PathSuspect suspect;
  /// Share of the compared walls that scans on the other side of the interruption see through, minus its
  /// standard deviation; in [0, 1]. Zero if too few walls could be compared.
  double contradicted = 0;
};

/// Checks the interruptions and gaps among the suspects: those of the kinds kLost and kGap. Compares
///  - the passes after an interruption with those before, over all places: a robot that was placed into a
///    similar corridor fits well at most of them. Comparisons across a stretch of `explained` are left out,
///    because that stretch explains a displacement. The passes must contradict each other at least twice as
///    often as other passes do, which drift displaces, too.
///  - the last scan before a gap with the first scan after it: they saw the same walls if the robot stood. A
///    tenth of the walls may differ, because people and doors move.
std::vector<InterruptionCheck> check_interruptions(const MappingResult& result,
                                                   const std::vector<MapView>& views,
                                                   const std::vector<PassCheck>& checks,
                                                   const std::vector<PathSuspect>& suspects,
                                                   const std::vector<FrameSpan>& explained,
                                                   const PassCheckOptions& options = {});

}  // namespace psi_slam
