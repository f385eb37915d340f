// SPDX-License-Identifier: BSD-3-Clause
// Determines from the scans of a log in which order a laser measures the beams of a scan. A robot that turns
// at the rate w during a sweep of the time T bends the scan by w T. Scans that are bent alike still fit each
// other. The study therefore compares pairs of scans with different bends, measured near each other: it
// de-skews both as if the first beam, the last beam or all beams at once were measured first, aligns them,
// and compares the distances of points to walls.
//
// The turn rates come from the alignment of each scan's neighbours. Odometry only selects the pairs and
// provides guesses of their motions; without odometry, scans are aligned one after the other.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Evidence for one order of the beams.
struct SweepFit {
  double mean_distance_m = 0;  ///< mean distance from points to walls, over all pairs of scans
  double worse_by_m = 0;       ///< mean_distance_m minus that of the best of the three orders
  /// Mean relative increase of the distance over that of the best order, in standard errors.
  double significance = 0;
  bool ruled_out = false;
};

/// Result for one laser.
struct SweepDirectionStudy {
  std::size_t scans = 0;           ///< scans with a sweep time that were read
  double stated_sweep_time_s = 0;  ///< sweep time of the last of them; negative: states the backward order
  std::size_t pairs = 0;           ///< pairs of scans that some order aligned reliably
  double mean_bend_rad = 0;        ///< mean difference of the bends of a pair
  SweepFit forward;                ///< the first beam is measured first
  SweepFit backward;               ///< the last beam is measured first
  SweepFit at_once;                ///< all beams are measured at the same time

  /// Returns the direction with the best fit. Returns kAuto unless the scans rule out the reverse direction
  /// and fit less well without any correction of the sweep.
  SweepDirection direction() const;
  /// Returns whether the scans rule out both directions, because they are not distorted or the sweep time is
  /// wrong.
  bool shows_no_sweep() const { return forward.ruled_out && backward.ruled_out; }
};

/// Reads the first part of a log, whose frames hold one scan each, and returns a study for each number of a
/// laser. Ends when each laser has turned eight times, or after 6000 frames. Ends early at an
/// error of the log, or if its first scans state no sweep time. `sweep_time_s` replaces the sweep time of all
/// scans.
std::vector<SweepDirectionStudy> study_sweep_directions(FrameSource& log, std::optional<double> sweep_time_s);

}  // namespace psi_slam
