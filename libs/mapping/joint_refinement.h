// SPDX-License-Identifier: BSD-3-Clause
// The last step to the map: every scan is laid anew on the surfaces that the scans near it saw, all at their
// optimised poses, once or in several rounds. The graph has brought the scans to within a few centimetres of
// where they belong, and bends no more; what is left is the noise of single poses, which local maps of whole
// cells cannot resolve.
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
  int rounds = 1;               ///< 0: none; poses stay as the graph has them
  std::size_t references = 12;  ///< nodes whose scans one scan is laid on, at most: those nearest to it,
  double reach_m = 3.0;         ///< at most this far
  double max_turn_rad = radians_from_degrees(70.0L);  ///< and turned by no more
  SurfaceAlignmentOptions alignment;
};

/// The scans to refine: all of the log, some of them nodes.
struct RefinedScans {
  std::vector<mrpt::math::TPose2D> map_T_frame;         ///< in, and out
  std::vector<std::size_t> node_frames;                 ///< the frame of each node, ascending
  std::function<ScanPoints(std::size_t frame)> points;  ///< called by several threads at once
};

/// Of every frame, laid on the scans of nodes near the node before it. In a round no frame sees where the
/// others went in it: no result depends on the order or the number of threads. `progress` is called with the
/// share done; when it returns false, the rounds that were finished count.
void refine_jointly(RefinedScans& scans, const JointRefinementOptions& options, WorkerPool& pool,
                    const std::function<bool(double)>& progress);

}  // namespace psi_slam
