// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/final_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "mapping/loop_closure/loop_attempt.h"

namespace psi_slam {
namespace {

// Number of pairs matched between two reports of progress.
constexpr std::size_t kBatch = 64;

/// Chooses the first node of each stretch of travel. The stretches of different local maps begin at different
/// places.
class NodeChoice {
 public:
  NodeChoice(const std::vector<NodeScan>& nodes, double stretch_m)
      : stretch_m_(stretch_m), moved_m_(nodes.size()) {
    for (std::size_t node = 1; node < nodes.size(); ++node)
      moved_m_[node] =
          moved_m_[node - 1] + travel_and_turn_m(nodes[node - 1].local_T_robot, nodes[node].local_T_robot);
  }

  bool contains(std::size_t node, std::size_t local_map) const {
    if (stretch_m_ <= 0 || node == 0) return true;
    return stretch(node, local_map) != stretch(node - 1, local_map);
  }

 private:
  double stretch(std::size_t node, std::size_t local_map) const {
    constexpr double kGoldenRatio = 0.618033988749895;  // spreads the offsets of any number of local maps
    const double turns = kGoldenRatio * static_cast<double>(local_map);
    return std::floor(moved_m_[node] / stretch_m_ + (turns - std::floor(turns)));
  }

  double stretch_m_;
  std::vector<double> moved_m_;  ///< travel and turns from the first node to each node
};

/// Bounding box of the nodes of a local map, to avoid computing distances to all nodes.
struct Box {
  double x_min, y_min, x_max, y_max;

  Box(const PlacedLocalMap& local_map, const PoseGraph& graph)
      : x_min(graph.pose(local_map.first_node).x),
        y_min(graph.pose(local_map.first_node).y),
        x_max(x_min),
        y_max(y_min) {
    for (std::size_t node = local_map.first_node + 1; node <= local_map.last_node; ++node) {
      const mrpt::math::TPose2D& pose = graph.pose(node);
      x_min = std::min(x_min, pose.x);
      y_min = std::min(y_min, pose.y);
      x_max = std::max(x_max, pose.x);
      y_max = std::max(y_max, pose.y);
    }
  }

  bool is_near(const mrpt::math::TPose2D& here, double reach_m) const {
    return x_min - here.x <= reach_m && here.x - x_max <= reach_m && y_min - here.y <= reach_m &&
           here.y - y_max <= reach_m;
  }
};

bool is_near(std::size_t node, const PlacedLocalMap& local_map, const PoseGraph& graph, double reach_m) {
  const mrpt::math::TPose2D& here = graph.pose(node);
  for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other) {
    const mrpt::math::TPose2D& there = graph.pose(other);
    if (distance_m(here, there) <= reach_m) return true;
  }
  return false;
}

struct Pair {
  std::size_t node = 0;
  LoopCandidate candidate;
};

std::vector<Pair> pairs_near_each_other(
    const KeyframeStore& keyframes, const PoseGraph& graph, const FinalSearchOptions& options,
    const std::function<bool(std::size_t node, std::size_t local_map)>& known) {
  std::vector<Pair> pairs;
  std::vector<int> maps_near(keyframes.nodes.size());
  for (std::size_t m = 0; m < keyframes.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = keyframes.local_maps[m];
    if (local_map.is_superseded) continue;
    const Box box(local_map, graph);
    for (std::size_t node = 0; node < keyframes.nodes.size(); ++node) {
      if (!keyframes.nodes[node].points || !box.is_near(graph.pose(node), options.reach_m)) continue;
      if (node >= local_map.first_node && node <= local_map.last_node) continue;
      if (!are_joined(node, local_map.first_node, keyframes) ||
          !is_near(node, local_map, graph, options.reach_m))
        continue;
      ++maps_near[node];
      if (known(node, m)) continue;
      Pair pair;
      pair.node = node;
      pair.candidate.local_map = m;
      pair.candidate.anchor_T_node = between(graph.pose(local_map.anchor), graph.pose(node));
      pair.candidate.extent = {options.window_m, options.window_m, options.window_rad};
      pairs.push_back(pair);
    }
  }
  const NodeChoice chosen(keyframes.nodes, options.travel_m);
  const auto is_superfluous = [&](const Pair& pair) {
    return maps_near[pair.node] > kFewMaps && !chosen.contains(pair.node, pair.candidate.local_map);
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_superfluous), pairs.end());
  return pairs;
}

}  // namespace

FinalSearchOutcome final_search(const KeyframeStore& keyframes, const PoseGraph& graph,
                                const NodeMatchers& matchers, const LoopVerificationOptions& verification,
                                const FinalSearchOptions& options,
                                const std::function<bool(std::size_t, std::size_t)>& known,
                                std::uint64_t run_seed, WorkerPool& pool,
                                const std::function<bool(double)>& progress) {
  const std::vector<Pair> pairs = pairs_near_each_other(keyframes, graph, options, known);
  FinalSearchOutcome outcome;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBatch) {
    const std::size_t end = std::min(begin + kBatch, pairs.size());
    std::vector<std::size_t> local_maps;
    for (std::size_t i = begin; i < end; ++i) local_maps.push_back(pairs[i].candidate.local_map);
    unpack_local_maps(keyframes, local_maps, pool);
    auto attempts = map_in_parallel<LoopAttempt>(pool, end - begin, [&](std::size_t index) {
      const auto& [node, candidate] = pairs[begin + index];
      return attempt_loop(node, *keyframes.nodes[node].points, candidate,
                          least_reported_response(candidate.extent, verification), keyframes, matchers,
                          verification, run_seed);
    });
    for (LoopAttempt& attempt : attempts) {
      outcome.effort += attempt.effort;
      if (!attempt.loop || found_nothing(*attempt.loop)) continue;
      attempt.loop->in_final_search = true;
      outcome.loops.push_back(*std::move(attempt.loop));
    }
    if (!progress(static_cast<double>(end) / static_cast<double>(pairs.size()))) break;
  }
  if (pairs.empty()) progress(1);
  return outcome;
}

}  // namespace psi_slam
