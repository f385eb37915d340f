// SPDX-License-Identifier: BSD-3-Clause
// Context of a scan: the scan together with the scans on the path before it. A single scan of a corridor fits
// many places along the corridor. The scans of the last metres, with their doors and niches, fit only one.
// Searches in wide windows match this context instead of the scan alone.
#pragma once

#include "mapping/loop_closure/keyframe_store.h"
#include "matching/scan_points.h"

namespace psi_slam {

struct ScanContextOptions {
  double travel_m = 8.0;         ///< length of the path before the scan that the context covers
  double node_spacing_m = 1.0;   ///< smallest distance along the path between scans of the context
  double point_spacing_m = 0.1;  ///< side length of squares; the context keeps one point per square
  /// Largest number of points. A larger context keeps this many, evenly spread over their order. This bounds
  /// the time of a search outdoors and in halls.
  int max_points = 1000;
};

/// Returns the points of the scans of `node` and of the nodes before it, in the robot frame at `node`. The
/// front end's poses place the scans.
ScanPoints scan_context(std::size_t node, const KeyframeStore& keyframes, const ScanContextOptions& options);

}  // namespace psi_slam
