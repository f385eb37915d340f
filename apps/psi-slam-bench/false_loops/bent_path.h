// SPDX-License-Identifier: BSD-3-Clause
// Slips of the front end: stretches of its path that are too long or too short, or turn too far to the left
// or to the right, with no sign of it in the covariances. Loops contradict such a path, and the back end must
// believe them.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct BentPathOptions {
  double share = 0.1;              ///< share of the stretches that are bent, 0 to 1; their number is rounded
  std::size_t stretch_nodes = 50;  ///< number of nodes of a stretch
  double stretching = 0.05;        ///< part by which every second bent stretch is too long or too short
  double turn_rad = radians_from_degrees(2.0L);  ///< by which the other bent stretches turn too far
  std::uint64_t seed = 1;
};

struct BentPath {
  PoseGraph graph;                            ///< with the constraints of the bent path; loops are unchanged
  std::vector<mrpt::math::TPose2D> unlooped;  ///< the bent path
  std::size_t stretches = 0;                  ///< number of bent stretches
};

/// Bends the front end's path `unlooped`, which has a pose for each node, and the measured poses of all
/// constraints of odometry and of local maps as if the front end had measured that path.
BentPath bent(const PoseGraph& graph, const std::vector<mrpt::math::TPose2D>& unlooped,
              const BentPathOptions& options);

}  // namespace psi_slam
