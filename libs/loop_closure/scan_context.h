// SPDX-License-Identifier: BSD-3-Clause
// A scan together with the scans on the path before it. One scan of a corridor fits many places along it; the
// last ten metres, with their doors and niches, fit one. Wide searches match this context instead of the scan
// alone.
#pragma once

#include "loop_closure/keyframe_store.h"
#include "matching/scan_points.h"

namespace psi_slam {

struct ScanContextOptions {
  double travel_m = 8.0;         ///< length of the path before the scan
  double node_spacing_m = 1.0;   ///< smallest distance between scans along the path
  double point_spacing_m = 0.1;  ///< keeps one point per square of this size
};

/// The points of the scans of `node` and of the nodes before it, placed by the front end, in the robot frame
/// at `node`.
ScanPoints scan_context(std::size_t node, const KeyframeStore& keyframes, const ScanContextOptions& options);

}  // namespace psi_slam
