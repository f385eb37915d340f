// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "localization/global_search.h"
#include "mapping/loop_closure/loop_consensus.h"

namespace psi_slam {

/// Compares the places that searches of a finished map found for nodes along a path. A place counts once
/// other places agree with it, see LoopConsensus. The response of a place is not weighed, because each place
/// was verified by the scans around it.
class PlaceConsensus {
 public:
  /// Places wait longer for others than loops do: searches of a whole map are 1 m of travel or more apart.
  explicit PlaceConsensus(const LoopConsensusOptions& options) : consensus_(with_long_memory(options)) {
    map_frame_.add_node({0, 0, 0});
  }

  /// Adds the place of a node. Returns whether others agree with it.
  bool add(std::size_t node, const KeyframeStore& keyframes, const FoundPlace& place) {
    const NodeScan& here = keyframes.nodes[node];
    const LoopConsensus::Vote vote{node, here.travelled_m,  here.local_T_robot,
                                   0,    place.map_T_robot, place.ambiguity};
    return !consensus_.add(vote, map_frame_).empty();
  }

 private:
  static LoopConsensusOptions with_long_memory(LoopConsensusOptions options) {
    options.memory_m = std::max(options.memory_m, 15.0);
    return options;
  }

  LoopConsensus consensus_;
  PoseGraph map_frame_;  // has one node, the origin of the map, as anchor of the places
};

}  // namespace psi_slam
