// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/superseded_maps.h"

#include <algorithm>
#include <cstdint>

#include "matching/point_grid.h"

namespace psi_slam {
namespace {

constexpr double kSamePlace_m = 1.0;

/// Nodes of the passes that loops tie to earlier passes.
class TiedPasses {
 public:
  TiedPasses(const KeyframeStore& keyframes, const PoseGraph& graph, double min_travel_m)
      : keyframes_(keyframes),
        graph_(graph),
        min_travel_m_(min_travel_m),
        nodes_(tied_nodes()),
        index_(positions(), kSamePlace_m / 2) {}

  /// Returns the number of passes at the place of a node, after it.
  std::size_t after(std::size_t node) const {
    const mrpt::math::TPose2D& here = graph_.pose(node);
    double last_m = keyframes_.nodes[node].travelled_m;
    std::size_t passes = 0;
    // Indices, and so the travelled lengths, are in ascending order.
    for (const std::uint32_t i : index_.within(position(here), static_cast<float>(kSamePlace_m))) {
      const std::size_t other = nodes_[i];
      const double travelled_m = keyframes_.nodes[other].travelled_m;
      if (other <= node || travel_and_turn_m(here, graph_.pose(other)) > kSamePlace_m) continue;
      if (travelled_m - last_m >= min_travel_m_) ++passes;
      last_m = travelled_m;
    }
    return passes;
  }

 private:
  bool is_tied(const PlacedLocalMap& local_map) const {
    for (std::size_t node = local_map.first_node; node <= local_map.last_node; ++node)
      for (const std::uint32_t index : graph_.constraints_of(node)) {
        const Constraint& loop = graph_.constraint(index);
        if (loop.kind != Constraint::Kind::kLoop || !graph_.enabled(index)) continue;
        const std::size_t other = loop.from == node ? loop.to : loop.from;
        if (keyframes_.nodes[other].travelled_m + min_travel_m_ <= keyframes_.nodes[node].travelled_m)
          return true;
      }
    return false;
  }

  std::vector<std::size_t> tied_nodes() const {
    std::vector<std::size_t> nodes;
    for (const PlacedLocalMap& local_map : keyframes_.local_maps) {
      if (local_map.is_superseded || !is_tied(local_map)) continue;
      for (std::size_t node = local_map.first_node; node <= local_map.last_node; ++node)
        if (nodes.empty() || node > nodes.back()) nodes.push_back(node);
    }
    return nodes;
  }

  std::vector<mrpt::math::TPoint2Df> positions() const {
    std::vector<mrpt::math::TPoint2Df> positions;
    for (const std::size_t node : nodes_) positions.push_back(position(graph_.pose(node)));
    return positions;
  }

  const KeyframeStore& keyframes_;
  const PoseGraph& graph_;
  double min_travel_m_;
  std::vector<std::size_t> nodes_;
  PointGrid index_;
};

}  // namespace

std::vector<std::size_t> superseded_maps(const KeyframeStore& keyframes, const PoseGraph& graph,
                                         double min_travel_m) {
  std::vector<std::size_t> superseded;
  const TiedPasses passes(keyframes, graph, min_travel_m);
  for (std::size_t m = 0; m < keyframes.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = keyframes.local_maps[m];
    const bool holds_root = local_map.first_node <= graph.root() && graph.root() <= local_map.last_node;
    if (local_map.is_superseded || holds_root || is_unplaced(local_map.first_node, keyframes)) continue;
    std::size_t node = local_map.first_node;
    while (node <= local_map.last_node && passes.after(node) >= kLaterPasses) ++node;
    if (node > local_map.last_node) superseded.push_back(m);
  }
  return superseded;
}

std::vector<std::size_t> drop_local_maps(const std::vector<std::size_t>& local_maps,
                                         KeyframeStore& keyframes) {
  for (const std::size_t m : local_maps) {
    PlacedLocalMap& local_map = keyframes.local_maps[m];
    local_map.is_superseded = true;
    local_map.map.reset();
    if (keyframes.cache) keyframes.cache->remove(m);
  }
  std::vector<std::size_t> dropped;
  for (const std::size_t m : local_maps) {
    const PlacedLocalMap& gone = keyframes.local_maps[m];
    for (std::size_t node = gone.first_node; node <= gone.last_node; ++node) {
      const auto holds_it = [&](const PlacedLocalMap& other) {
        return !other.is_superseded && other.first_node <= node && node <= other.last_node;
      };
      const auto& all = keyframes.local_maps;
      if (!keyframes.nodes[node].points || std::any_of(all.begin(), all.end(), holds_it)) continue;
      keyframes.nodes[node].points.reset();
      dropped.push_back(node);
    }
  }
  std::sort(dropped.begin(), dropped.end());
  return dropped;
}

}  // namespace psi_slam
