// SPDX-License-Identifier: BSD-3-Clause
// False loops, made up for a pose graph: what a matcher would add that takes one place for another.
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
  kScattered,  ///< each says something else
  kGroups,     ///< some successive nodes all say the same wrong place in the same local map
  kNearby,     ///< true loops, metres off: within what odometry's uncertainty cannot tell
};

/// "scattered", "groups", "nearby".
std::string name_of(FalseLoopKind kind);

struct FalseLoopOptions {
  FalseLoopKind kind = FalseLoopKind::kScattered;
  std::size_t count = 0;
  std::size_t smallest_group = 5;
  std::size_t largest_group = 10;
  double reach_m = 10;  ///< the wrong place is at most this far from the anchor: the local map would be there
  double nearby_m = 3;  ///< nearby ones are off by min_error_m to this, and turned by up to min_error_rad
  double min_error_m = 1;  ///< a loop is false when it is at least so far off the truth, ...
  double min_error_rad = radians_from_degrees(20.0L);  ///< ... or turned by so much
  std::uint64_t seed = 1;
};

/// Adds loops between nodes and anchors of the graph's local maps, both drawn at random, and returns their
/// constraints' numbers. The node's place in the local map is drawn anywhere within reach, with any heading;
/// the information is that of a loop of the graph, drawn too. The successive nodes of a group move as
/// `map_T_node`, the truth, says, so that they agree with each other to the millimetre: worse than any
/// matcher's. None when the graph has no loop that is on.
std::vector<std::size_t> add_false_loops(PoseGraph& graph, const std::vector<mrpt::math::TPose2D>& map_T_node,
                                         const FalseLoopOptions& options);

}  // namespace psi_slam
