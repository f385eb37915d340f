// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/loop_closer.h"

#include <cmath>
#include <limits>
#include <optional>

#include "loop_attempt.h"
#include "psi_slam/pose_graph/path_covariance.h"

namespace psi_slam {
namespace {

// The node's uncertainty seen from each local map's anchor: heading errors at the node count with the
// distance.
std::vector<PositionSigma> sigma_of_anchors(std::size_t node, const PlaceMemory& memory,
                                            const PoseGraph& graph) {
  const std::vector<RelativeUncertainty> uncertainties = path_covariances(graph, node);
  std::vector<PositionSigma> sigma;
  for (const PlacedLocalMap& local_map : memory.local_maps) {
    const RelativeUncertainty& anchor = uncertainties[local_map.anchor];
    const double heading = std::sqrt(anchor.covariance(2, 2));
    const mrpt::math::TPose2D between = graph.pose(node) - graph.pose(local_map.anchor);
    sigma.push_back(
        {std::hypot(anchor.position_sigma_m(), heading * std::hypot(between.x, between.y)), heading});
  }
  return sigma;
}

}  // namespace

std::vector<LoopRecord> LoopCloser::close(std::size_t node, const PlaceMemory& memory, const PoseGraph& graph,
                                          const Matcher& matcher) {
  std::vector<LoopRecord> loops;
  tried_ = 0;
  const NodeScan& here = memory.nodes[node];
  last_attempt_m_.resize(memory.local_maps.size(), -std::numeric_limits<double>::infinity());
  const std::vector<PositionSigma> sigma = sigma_of_anchors(node, memory, graph);
  std::optional<ScanPoints> context;
  for (const LoopCandidate& candidate : loop_candidates(node, memory, graph, sigma, options_.candidates)) {
    if (here.travelled_m - last_attempt_m_[candidate.local_map] < options_.attempt_distance_m) continue;
    last_attempt_m_[candidate.local_map] = here.travelled_m;
    ++tried_;
    const bool wide = is_wide(candidate.extent, options_.verification);
    if (wide && !context) context = scan_context(node, memory, options_.context);
    if (auto loop = attempt_loop(node, wide ? *context : *here.points, candidate, memory, matcher,
                                 options_.verification))
      loops.push_back(std::move(*loop));
  }
  return loops;
}

}  // namespace psi_slam
