// SPDX-License-Identifier: BSD-3-Clause
// A bound on the uncertainty between one node and all others that costs one walk over the graph, no
// factorisation: the covariance of the relative pose accumulated along one short chain of constraints, the
// "Dijkstra projection" of Olson, "Recognizing places using spectrally clustered local matches", RAS 57
// (2009). What other constraints know is left out, so that the bound is too large rather than too small.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct PathCovarianceOptions {
  /// A chain's cost is the trace of its position covariance plus the square of this length times its heading
  /// variance: heading errors at a node become position errors further on.
  double heading_lever_m = 2;
  /// Nodes that cost more than the square of this are not reached.
  double max_sigma_m = std::numeric_limits<double>::infinity();
  /// If not empty, the search ends when all of these are reached.
  std::vector<std::size_t> targets;
};

/// The pose of one node in the axes of the source.
struct RelativeUncertainty {
  bool reached = false;
  std::size_t previous = 0;    ///< node before this one on the chain from the source; the source's is itself
  std::size_t constraint = 0;  ///< from the previous node to this one, in either direction; not of the source
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): m^2, m rad, rad^2

  /// The largest standard deviation of the position over all directions.
  double position_sigma_m() const;
};

/// The search, with memory that it keeps from one run to the next: a run that ends at its targets or its
/// bound costs no more than the nodes that it comes by, however large the graph.
class PathCovarianceSearch {
 public:
  /// Chains use the enabled constraints, and the current poses for the lever arms. They grow from the
  /// cheapest end first, as in Dijkstra's algorithm, ties by the lower node: greedy, because the cost of a
  /// chain may fall again on its way back towards the source. Throws std::out_of_range when a node does not
  /// exist.
  void run(const PoseGraph& graph, std::size_t source, const PathCovarianceOptions& options = {});

  /// What the last run found of a node of its graph.
  RelativeUncertainty of(std::size_t node) const;

  /// How many nodes the last run came by.
  std::size_t nodes_seen() const { return seen_; }

 private:
  // A symmetric 3x3 covariance of (x, y, theta), x and y in the axes of the map.
  struct Covariance {
    double xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0;
  };
  struct Node {
    std::uint64_t run = 0;  // that the rest is of
    double x = 0, y = 0, cosine = 1, sine = 0;
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t constraint = 0;
    std::uint32_t previous = 0;
    bool settled = false;
    bool wanted = false;
    Covariance covariance;
  };
  using Entry = std::pair<double, std::uint32_t>;  // cost, node

  static Covariance turned(const Covariance& a, double cosine, double sine);
  static Covariance carried(const Covariance& a, double dx, double dy);
  static void add(Covariance& a, const Covariance& b);
  static Covariance extended(const Covariance& at_previous, const GraphLink& link, const Node& previous,
                             const Node& next, bool forwards);
  static double extended_cost(const Covariance& at_previous, const GraphLink& link, const Node& previous,
                              const Node& next, bool forwards, double lever2);
  Node& node_at(const PoseGraph& graph, std::size_t node);
  void settle(const PoseGraph& graph, std::uint32_t here);
  void look_around(const PoseGraph& graph, std::uint32_t here, double lever2, double max_cost);

  std::vector<Node> nodes_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::uint64_t run_ = 0;
  std::size_t source_ = 0;
  std::size_t seen_ = 0;
};

/// One entry a node: see PathCovarianceSearch::run().
std::vector<RelativeUncertainty> path_covariances(const PoseGraph& graph, std::size_t source,
                                                  const PathCovarianceOptions& options = {});

}  // namespace psi_slam
