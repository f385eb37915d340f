// SPDX-License-Identifier: BSD-3-Clause
// Upper bound of the uncertainty between one node and all others, from one traversal of the graph without a
// factorisation. The search accumulates the covariance of the relative pose along one short chain of
// constraints: the "Dijkstra projection" of Olson, "Recognizing places using spectrally clustered local
// matches", RAS 57 (2009). It ignores the information of constraints outside the chain.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "pose_graph/constraint_error.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct PathCovarianceOptions {
  bool with_doubt = false;  ///< whether to add Constraint::doubt
  /// The cost of a chain, in m^2, is the trace of its position covariance, plus its heading variance times
  /// the square of this length. Heading errors become position errors along the chain.
  double heading_lever_m = 2;
  /// The search does not visit nodes whose cost exceeds the square of this length.
  double max_sigma_m = std::numeric_limits<double>::infinity();
  /// If not empty, the search ends when it has reached all these nodes, and may skip others.
  std::vector<std::size_t> targets;
};

/// Uncertainty of the pose of one node in the axes of the source.
struct RelativeUncertainty {
  bool reached = false;
  std::size_t previous = 0;  ///< previous node on the chain from the source; the source itself for the source
  std::size_t constraint = 0;  ///< number of the constraint to the previous node; undefined for the source
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of (x, y, theta): m^2, m rad, rad^2

  /// Largest standard deviation of the position over all directions, in metres.
  double position_sigma_m() const;
};

/// Finds the covariances of nodes relative to a source node. Reuses its memory, so that the time of a search
/// depends on the number of nodes visited, not on the size of the graph.
class PathCovarianceSearch {
 public:
  /// Runs the search from `source`. Chains use the enabled constraints, and the current poses for lever arms.
  /// The search extends the cheapest chain first, as in Dijkstra's algorithm; ties go to the node with the
  /// lower number. A chain found this way need not be the cheapest one, because costs can fall where a chain
  /// turns back towards the source. Throws std::out_of_range if a node does not exist.
  void run(const PoseGraph& graph, std::size_t source, const PathCovarianceOptions& options = {});

  /// Uncertainty of `node` that the last search found; `reached` is false if the search did not reach the
  /// node.
  RelativeUncertainty of(std::size_t node) const;

  /// Number of nodes that the last search visited.
  std::size_t nodes_seen() const { return seen_; }

 private:
  struct Node {
    std::uint64_t run = 0;  // number of the search that set the other members
    RotatedPose pose;
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t constraint = 0;
    std::uint32_t previous = 0;
    bool settled = false;
    bool wanted = false;
    bool rotated = false;       // whether sine and cosine of `pose` are set
    PoseCovariance covariance;  // of the pose relative to the source, in the axes of the map
  };
  using Entry = std::pair<double, std::uint32_t>;  // cost in m^2, node

  Node& node_at(const PoseGraph& graph, std::size_t node);
  static void rotate(Node& node);
  void settle(const PoseGraph& graph, std::uint32_t here);
  PoseCovariance measured_by(const GraphLink& link) const;
  void look_around(const PoseGraph& graph, std::uint32_t here, double lever2, double max_cost);

  std::vector<Node> nodes_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::uint64_t run_ = 0;
  std::size_t source_ = 0;
  bool with_doubt_ = false;
  bool only_targets_ = false;  // whether nodes that are no targets need no result
  std::size_t seen_ = 0;
};

}  // namespace psi_slam
