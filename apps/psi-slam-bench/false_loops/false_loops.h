// SPDX-License-Identifier: BSD-3-Clause
// Random false loops for a pose graph, like those of a matcher that mistakes one place for another.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

enum class FalseLoopKind {
  kScattered,  ///< independent of each other
  kGroups,     ///< several successive nodes agree on the same wrong place
  kNearby,     ///< true loops moved by metres, within the uncertainty of odometry
};

/// "scattered", "groups", "nearby".
std::string name_of(FalseLoopKind kind);

struct FalseLoopOptions {
  FalseLoopKind kind = FalseLoopKind::kScattered;
  std::size_t count = 0;
  std::size_t smallest_group = 5;
  std::size_t largest_group = 10;
  double reach_m = 10;  ///< largest distance of the wrong place from the anchor
  double nearby_m = 3;  ///< nearby loops are moved by min_error_m to this and rotated by up to min_error_rad
  double min_error_m = 1;  ///< a loop is false if it is at least this far off the truth
  double min_error_rad = radians_from_degrees(20.0L);  ///< or rotated by at least this
  std::uint64_t seed = 1;
};

/// Adds loops between random nodes and random anchors of local maps, and returns the indices of their
/// constraints. The place in the local map is random within reach, with any heading; the information is that
/// of a random loop of the graph. The successive nodes of a group move as in the truth `map_T_node`, so that
/// they agree exactly, which is harder than the output of any matcher. Adds nothing to a graph without
/// enabled loops.
std::vector<std::size_t> add_false_loops(PoseGraph& graph, const std::vector<mrpt::math::TPose2D>& map_T_node,
                                         const FalseLoopOptions& options);

}  // namespace psi_slam
