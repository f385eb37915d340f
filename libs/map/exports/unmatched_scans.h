// SPDX-License-Identifier: BSD-3-Clause
// Scans that matched no local map. Odometry, or the constant-velocity model, places these scans, so the map
// may be wrong there unless the verdict confirms the motion.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "map/verdict/map_verdict.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Successive unmatched scans of one run.
struct UnmatchedStretch {
  std::size_t run = 0;          ///< number of the run, from 0
  std::size_t first_frame = 0;  ///< index; never the first scan of the run, which has no local map yet
  std::size_t last_frame = 0;
  TimeUs first_time_us = 0;  ///< time of the first scan of the stretch
  TimeUs last_time_us = 0;   ///< time of the last scan of the stretch
  TimeUs run_start_us = 0;   ///< time of the first scan of the run
  /// Path by odometry or the constant-velocity model, from the scan before the stretch to the last scan.
  double predicted_length_m = 0;

  std::size_t scans() const { return last_frame - first_frame + 1; }
};

/// Unmatched scans of all runs.
struct UnmatchedScans {
  std::size_t count = 0;                    ///< scans of all stretches
  std::vector<UnmatchedStretch> stretches;  ///< in the order of the log
};

/// Finds the unmatched scans of each run. `runs` comes from runs_of().
UnmatchedScans unmatched_scans(const std::vector<FrameRecord>& frames, const std::vector<FrameSpan>& runs);

/// Returns a message about the unmatched scans of a result: a sentence without full stop that lists the
/// stretches with the longest paths. It warns of those that `verdict` does not confirm, or of all if
/// `verdict` is null. Empty if there are no unmatched scans, or if the robot moved less than 0.1 m in total
/// during these scans.
std::optional<std::string> unmatched_scans_text(const MappingResult& result,
                                                const MapVerdict* verdict = nullptr);

}  // namespace psi_slam
