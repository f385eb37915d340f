// SPDX-License-Identifier: BSD-3-Clause
// Loops found in wide windows wait here until others agree. Where the pose is known to metres only, one match
// proves little: equal doors along a corridor give it several good places. But every match says where the
// front end's frame lies in the map, and as the robot goes on, the true place says the same again and again,
// from other scans and other local maps, while the false ones scatter. A match weighs the more, the less
// ambiguous it is.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopConsensusOptions {
  double memory_m = 15.0;     ///< matches farther back along the path no longer count
  double same_place_m = 0.5;  ///< matches agree when they put the robot this near to each other,
  double same_heading_rad = radians_from_degrees(3.5L);  ///< and turned by no more than this
  double min_span_m = 1.0;  ///< of the path, between the first and the last match that agree
  double min_weight = 0.5;  ///< of those that agree together; a match weighs 1 - ambiguity, at least 0.05
  double max_rival_share = 0.5;  ///< of that weight, which any other place may have
};

class LoopConsensus {
 public:
  explicit LoopConsensus(const LoopConsensusOptions& options) : options_(options) {}

  struct Vote {
    std::size_t loop = 0;                ///< the caller's number for it
    double travelled_m = 0;              ///< along the path
    mrpt::math::TPose2D local_T_robot;   ///< by the front end
    std::size_t anchor = 0;              ///< a node of the graph,
    mrpt::math::TPose2D anchor_T_robot;  ///< from which the match sees the robot
    double ambiguity = 0;
  };

  /// Adds a vote; returns the loops that are now confirmed, this one among them, or none. Confirmed ones are
  /// forgotten. Of the votes before, those count whose loops still wait.
  std::vector<std::size_t> add(const Vote& vote, const PoseGraph& graph,
                               const std::function<bool(std::size_t loop)>& still_waits = {});

 private:
  bool agree(const Vote& a, const Vote& b, const PoseGraph& graph) const;

  LoopConsensusOptions options_;
  std::vector<Vote> votes_;
};

}  // namespace psi_slam
