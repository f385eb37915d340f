// SPDX-License-Identifier: BSD-3-Clause
// The last step of mapping: aligns every scan with the surfaces seen by the scans near it, all at their
// optimised poses, in one or several rounds. After optimisation the scans are within a few centimetres of
// their true poses. What remains is noise of single poses below the cell size of local maps.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "matching/scan_points.h"
#include "matching/surface_alignment.h"

namespace psi_slam {

struct JointRefinementOptions {
  int rounds = 1;               ///< 0: no refinement
  std::size_t references = 12;  ///< largest number of nodes that a scan is aligned with, the nearest ones
  double reach_m = 3.0;         ///< largest distance to such a node
  double max_turn_rad = radians_from_degrees(70.0L);  ///< largest turn from the heading of such a node
  SurfaceAlignmentOptions alignment;
};

/// The scans to refine: all of the log or all nodes.
struct RefinedScans {
  std::vector<mrpt::math::TPose2D> map_T_frame;         ///< in, and out
  std::vector<std::size_t> node_frames;                 ///< the frame of each node, ascending
  std::function<ScanPoints(std::size_t frame)> points;  ///< several threads call it at once
};

/// Aligns every frame with the scans of nodes near its previous node. A round uses the poses of the round
/// before, so results do not depend on the order or the number of threads. `progress` gets the share done; if
/// it returns false, only finished rounds count.
void refine_jointly(RefinedScans& scans, const JointRefinementOptions& options, WorkerPool& pool,
                    const std::function<bool(double)>& progress);

}  // namespace psi_slam
