// SPDX-License-Identifier: BSD-3-Clause
// The last step of mapping: aligns every scan with the surfaces seen by the scans near it, in one or several
// rounds. All scans start at the poses of the optimised graph, which are accurate to a few centimetres. The
// refinement reduces the remaining noise of single poses, which is below the cell size of local maps.
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
  int rounds = 1;               ///< number of rounds; 0: no refinement
  std::size_t references = 12;  ///< largest number of nearby nodes that a scan is aligned with
  double reach_m = 3.0;         ///< largest distance of these nodes from the scan's previous node
  double max_turn_rad = radians_from_degrees(70.0L);  ///< largest heading difference from the previous node
  SurfaceAlignmentOptions alignment;
};

/// The scans to refine: either all scans of the log or only the nodes.
struct RefinedScans {
  std::vector<mrpt::math::TPose2D> map_T_frame;         ///< pose of each frame; refine_jointly() replaces it
  std::vector<std::size_t> node_frames;                 ///< frame number of each node, ascending
  std::function<ScanPoints(std::size_t frame)> points;  ///< points of a frame; must be thread-safe
};

/// Aligns every frame with the scans of nodes near its previous node. Each round uses the poses of the round
/// before, so results do not depend on the order of the frames or the number of threads. `progress` gets the
/// completed share of the work, in [0, 1]. If `progress` returns false, the unfinished round is discarded.
void refine_jointly(RefinedScans& scans, const JointRefinementOptions& options, WorkerPool& pool,
                    const std::function<bool(double)>& progress);

}  // namespace psi_slam
