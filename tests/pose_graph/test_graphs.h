// SPDX-License-Identifier: BSD-3-Clause
// Pose graphs with known true poses, for tests.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <random>
#include <vector>

#include "logs/frames/pose_operations.h"
#include "pose_graph/constraint_error.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

using mrpt::math::TPose2D;

/// Pose of b in the axes of a.
inline TPose2D relative_pose(const TPose2D& a, const TPose2D& b) {
  const double c = std::cos(a.phi);
  const double s = std::sin(a.phi);
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  return {c * dx + s * dy, c * dy - s * dx, wrap_to_pi(b.phi - a.phi)};
}

/// A graph, and the true poses that its constraints were measured from.
struct KnownGraph {
  PoseGraph graph;
  std::vector<TPose2D> truth;
};

/// Draws measurements of true poses with Gaussian noise by the Box-Muller method. The same seed gives the
/// same measurements on every platform.
class Measurer {
 public:
  explicit Measurer(std::uint64_t seed) : random_(seed) {}

  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform()); }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

  /// Returns a measured constraint. `noise` scales the drawn errors, not the information.
  Constraint measure(const std::vector<TPose2D>& truth, std::size_t from, std::size_t to,
                     Constraint::Kind kind, double sigma_m, double sigma_rad, double noise = 1) {
    Constraint constraint;
    constraint.from = from;
    constraint.to = to;
    constraint.kind = kind;
    constraint.from_T_to = relative_pose(truth[from], truth[to]);
    constraint.from_T_to.x += noise * sigma_m * normal();
    constraint.from_T_to.y += noise * sigma_m * normal();
    constraint.from_T_to.phi = wrap_to_pi(constraint.from_T_to.phi + noise * sigma_rad * normal());
    constraint.information =
        Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
            .asDiagonal();
    return constraint;
  }

 private:
  std::mt19937_64 random_;
};

/// Adds node k at the end of the odometry constraint from node k - 1 to node k, as dead reckoning does.
inline void add_by_odometry(PoseGraph& graph, const Constraint& odometry) {
  graph.add_node(compose(graph.pose(odometry.from), odometry.from_T_to));
  graph.add_constraint(odometry);
}

/// Returns the graph of one lap on a circle with steps of 1 m, closed by `loops` precise constraints between
/// its ends.
inline KnownGraph ring(std::size_t nodes, std::size_t loops, double noise, double loop_sigma_m = 0.01,
                       double loop_sigma_rad = 0.002, std::uint64_t seed = 1) {
  KnownGraph result;
  Measurer measurer(seed);
  const double radius = static_cast<double>(nodes) / (2 * M_PI);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(nodes);
    result.truth.emplace_back(radius * std::sin(angle), radius * (1 - std::cos(angle)), wrap_to_pi(angle));
  }
  result.graph.add_node(result.truth[0]);
  for (std::size_t i = 1; i < nodes; ++i)
    add_by_odometry(result.graph,
                    measurer.measure(result.truth, i - 1, i, Constraint::Kind::kOdometry, 0.05, 0.01, noise));
  for (std::size_t i = 0; i < loops; ++i)
    result.graph.add_constraint(measurer.measure(result.truth, i, nodes - loops + i, Constraint::Kind::kLoop,
                                                 loop_sigma_m, loop_sigma_rad, noise));
  return result;
}

/// Returns the graph of a random walk over a grid of corridors, which are 4 m apart, with steps of 0.5 m.
/// Each local map has 40 nodes. Constraints lead to each node from the previous node, from the anchors of the
/// last `local_maps` local maps, and as loops from the anchors of older local maps within 6 m.
inline KnownGraph building(std::size_t nodes, std::size_t local_maps, std::size_t max_loops_per_node,
                           std::uint64_t seed = 1, double noise = 1) {
  constexpr std::size_t kMapNodes = 40;
  constexpr double kStep = 0.5;
  constexpr double kHalfWidth = 40;
  KnownGraph result;
  Measurer measurer(seed);
  std::vector<TPose2D>& truth = result.truth;
  truth.emplace_back(0, 0, 0);
  while (truth.size() < nodes) {
    TPose2D next = truth.back();
    const bool crossing = truth.size() % 8 == 0;
    if (crossing) {
      const std::size_t turn = measurer.index(4);
      if (turn == 0) next.phi = wrap_to_pi(next.phi + M_PI / 2);
      if (turn == 1) next.phi = wrap_to_pi(next.phi - M_PI / 2);
      const double ahead_x = next.x + 4 * std::cos(next.phi);
      const double ahead_y = next.y + 4 * std::sin(next.phi);
      if (std::abs(ahead_x) > kHalfWidth || std::abs(ahead_y) > kHalfWidth)
        next.phi = wrap_to_pi(next.phi + M_PI);
    }
    next.x += kStep * std::cos(next.phi);
    next.y += kStep * std::sin(next.phi);
    truth.push_back(next);
  }
  result.graph.add_node(truth[0]);
  for (std::size_t i = 1; i < nodes; ++i) {
    add_by_odometry(result.graph,
                    measurer.measure(truth, i - 1, i, Constraint::Kind::kOdometry, 0.01, 0.003, noise));
    const std::size_t map = i / kMapNodes;
    for (std::size_t back = 0; back < local_maps && back <= map; ++back) {
      const std::size_t anchor = (map - back) * kMapNodes;
      if (anchor + 1 < i)
        result.graph.add_constraint(
            measurer.measure(truth, anchor, i, Constraint::Kind::kLocalMap, 0.02, 0.005, noise));
    }
    std::size_t loops = 0;
    for (std::size_t old = 0; old + local_maps < map && loops < max_loops_per_node; ++old) {
      const std::size_t anchor = old * kMapNodes;
      if (std::hypot(truth[anchor].x - truth[i].x, truth[anchor].y - truth[i].y) > 6) continue;
      result.graph.add_constraint(
          measurer.measure(truth, anchor, i, Constraint::Kind::kLoop, 0.03, 0.005, noise));
      ++loops;
    }
  }
  return result;
}

/// Largest distance of a node from its true position, in metres.
inline double max_position_error(const KnownGraph& known) {
  double largest = 0;
  for (std::size_t i = 0; i < known.truth.size(); ++i)
    largest = std::max(largest, std::hypot(known.graph.pose(i).x - known.truth[i].x,
                                           known.graph.pose(i).y - known.truth[i].y));
  return largest;
}

}  // namespace psi_slam
