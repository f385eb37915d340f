// SPDX-License-Identifier: BSD-3-Clause
// Loops found in wide windows wait here until other matches agree. If the pose is known to metres only, one
// match proves little: equal doors along a corridor fit several places. But every match implies a pose of the
// front end's frame in the map. True matches of later scans imply the same pose, while false ones scatter.
// The weight of a match decreases with its ambiguity.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopConsensusOptions {
  double memory_m = 15.0;                                ///< length of the path whose matches count
  double same_place_m = 0.5;                             ///< largest distance between poses that agree
  double same_heading_rad = radians_from_degrees(3.5L);  ///< largest turn between poses that agree
  double min_span_m = 1.0;       ///< shortest path between the first and the last match that agree
  double min_weight = 0.5;       ///< of all matches that agree; one match weighs 1 - ambiguity, at least 0.05
  double max_rival_share = 0.5;  ///< largest weight of another place, as a share of that weight
};

class LoopConsensus {
 public:
  explicit LoopConsensus(const LoopConsensusOptions& options) : options_(options) {}

  struct Vote {
    std::size_t loop = 0;                ///< number given by the caller
    double travelled_m = 0;              ///< along the path
    mrpt::math::TPose2D local_T_robot;   ///< by the front end
    std::size_t anchor = 0;              ///< a node of the graph
    mrpt::math::TPose2D anchor_T_robot;  ///< by the match
    double ambiguity = 0;
  };

  /// Adds a vote. Returns the loops confirmed by it, itself included, or none. Clears the votes after a
  /// confirmation. Earlier votes count while `still_waits` holds for their loops.
  std::vector<std::size_t> add(const Vote& vote, const PoseGraph& graph,
                               const std::function<bool(std::size_t loop)>& still_waits = {});

 private:
  bool agree(const Vote& a, const Vote& b, const PoseGraph& graph) const;

  LoopConsensusOptions options_;
  std::vector<Vote> votes_;
};

}  // namespace psi_slam
