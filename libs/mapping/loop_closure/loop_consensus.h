// SPDX-License-Identifier: BSD-3-Clause
// Consensus of loops found in wide windows: each loop is a candidate until other matches agree with it. If
// the pose is only known to within metres, one match proves little, because equal doors along a corridor fit
// several places. But every match implies a pose of the front end's frame in the map. True matches of several
// scans imply the same pose, whereas false matches imply different poses. The weight of a match decreases
// with its ambiguity, down to 0: along a corridor with equal doors, matches that are all off by the same
// number of doors agree with each other for as long as the robot follows the corridor. For the same reason,
// only matches within a few metres of travel count together. A response below 0.6 multiplies the weight by
// (response / 0.6)^2. If the true place is outside the window or in another local map, several matches with
// responses of 0.4 to 0.5 may agree on a similar place. But two matches suffice, also with
// responses of 0.35, if they are not ambiguous. One match alone never suffices: it counts for at most half of
// the needed weight. The prior by the path multiplies each weight.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopConsensusOptions {
  double memory_m = 4.0;                                 ///< path length after which a match no longer counts
  double same_place_m = 0.5;                             ///< maximum distance between poses that agree
  double same_heading_rad = radians_from_degrees(3.5L);  ///< maximum turn between poses that agree
  /// Minimum path length between the first and the last agreeing match that have a weight.
  double min_span_m = 1.0;
  /// Minimum sum of agreeing weights. A weight is 1 - ambiguity, or 0 if that is below 0.05. A response
  /// below 0.6 multiplies it by (response / 0.6)^2.
  double min_weight = 0.5;
  double max_rival_share = 0.5;  ///< largest weight of another place, divided by the sum of agreeing weights
};

class LoopConsensus {
 public:
  explicit LoopConsensus(const LoopConsensusOptions& options) : options_(options) {}

  struct Vote {
    std::size_t loop = 0;                ///< number of the loop, chosen by the caller
    double travelled_m = 0;              ///< path length up to the scan
    mrpt::math::TPose2D local_T_robot;   ///< pose by the front end
    std::size_t anchor = 0;              ///< anchor of the matched local map
    mrpt::math::TPose2D anchor_T_robot;  ///< matched pose
    double ambiguity = 0;
    double response = 1;  ///< of the match, 0 to 1; 1 does not weigh it
    double prior = 1;     ///< weight that the path gives to the matched position, see path_prior()
  };

  /// Adds a vote. Returns the loops that it confirms, including its own loop; empty without a confirmation.
  /// Clears all votes after a confirmation. Votes for loops for which `still_waits` is false do not count.
  std::vector<std::size_t> add(const Vote& vote, const PoseGraph& graph,
                               const std::function<bool(std::size_t loop)>& still_waits = {});

 private:
  bool agree(const Vote& a, const Vote& b, const PoseGraph& graph) const;

  LoopConsensusOptions options_;
  std::vector<Vote> votes_;
};

}  // namespace psi_slam
