// SPDX-License-Identifier: BSD-3-Clause
// A scan with what was seen on the way to it. One scan of a corridor fits that corridor in many places; the
// last ten metres of it, with their doors and niches, fit in one. Wide searches match the context instead of
// the scan alone.
#pragma once

#include "loop_closure/keyframe_store.h"
#include "matching/scan_points.h"

namespace psi_slam {

struct ScanContextOptions {
  double travel_m = 8.0;         ///< of the path before the scan
  double node_spacing_m = 1.0;   ///< scans nearer than this along the path are left out
  double point_spacing_m = 0.1;  ///< one point a square of this size
};

/// The points of the scans of `node` and of the nodes before it, as they lie in the front end's frame, seen
/// from the robot at `node`.
ScanPoints scan_context(std::size_t node, const KeyframeStore& memory, const ScanContextOptions& options);

}  // namespace psi_slam
