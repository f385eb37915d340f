// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_consensus.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

// Matches whose ambiguity leaves less than this count for nothing, however many they are.
constexpr double kLeastUniqueness = 0.05;

// Matches with this response or more count fully. True matches in wide windows may have no more than 0.6
// where a corridor looks alike for a long way.
constexpr double kFullResponse = 0.6;

double weight(const LoopConsensus::Vote& vote) {
  const double uniqueness = 1 - vote.ambiguity;
  const double strength = std::min(1.0, vote.response / kFullResponse);
  return uniqueness < kLeastUniqueness ? 0 : uniqueness * strength * strength * vote.prior;
}

}  // namespace

// Returns whether two matches imply the same robot pose at the scan of `b`. The front end's motion carries
// the pose of match `a` to that scan.
bool LoopConsensus::agree(const Vote& a, const Vote& b, const PoseGraph& graph) const {
  const mrpt::math::TPose2D carried =
      compose(compose(graph.pose(a.anchor), a.anchor_T_robot), between(a.local_T_robot, b.local_T_robot));
  const mrpt::math::TPose2D off = between(carried, compose(graph.pose(b.anchor), b.anchor_T_robot));
  return portable::hypot(off.x, off.y) <= options_.same_place_m &&
         std::abs(off.phi) <= options_.same_heading_rad;
}

std::vector<std::size_t> LoopConsensus::add(const Vote& vote, const PoseGraph& graph,
                                            const std::function<bool(std::size_t)>& still_waits) {
  const auto too_old = [&](const Vote& old) {
    return std::abs(vote.travelled_m - old.travelled_m) > options_.memory_m;
  };
  votes_.erase(std::remove_if(votes_.begin(), votes_.end(), too_old), votes_.end());
  votes_.push_back(vote);
  std::vector<Vote> counted;
  std::copy_if(votes_.begin(), votes_.end(), std::back_inserter(counted),
               [&](const Vote& one) { return !still_waits || still_waits(one.loop); });

  double together = 0;
  double proof = 0;  // the same sum, of which one match gives at most half of what is needed
  double first_m = vote.travelled_m;
  double last_m = first_m;  // not always that of the newest vote: searches may be made up for later
  for (const Vote& other : counted) {
    if (!agree(other, vote, graph)) continue;
    together += weight(other);
    proof += std::min(weight(other), options_.min_weight / 2);
    if (weight(other) == 0) continue;
    first_m = std::min(first_m, other.travelled_m);
    last_m = std::max(last_m, other.travelled_m);
  }
  if (proof < options_.min_weight || last_m - first_m < options_.min_span_m) return {};
  for (const Vote& opponent : counted) {
    if (agree(opponent, vote, graph)) continue;
    double against = 0;
    for (const Vote& other : counted)
      if (!agree(other, vote, graph) && agree(other, opponent, graph)) against += weight(other);
    if (against > options_.max_rival_share * together) return {};
  }

  std::vector<std::size_t> confirmed;
  for (const Vote& other : counted)
    if (agree(other, vote, graph)) confirmed.push_back(other.loop);
  votes_.clear();
  return confirmed;
}

}  // namespace psi_slam
