// SPDX-License-Identifier: BSD-3-Clause
// Optimises a growing pose graph at a cost that depends mainly on what new constraints change. Only the
// core-node solve and one pass over all poses scale with the size of the graph. Between complete solutions by
// SparsePoseAdjustment, takes Gauss-Newton steps of the same robust error sum and reuses most terms of
// earlier steps:
//
// - Most nodes are leaves: their constraints lead only to core nodes, such as the first nodes of segments.
//   The poses of leaves are eliminated, and only the core nodes remain in the equations that are factorised.
// - Constraints are linearised again only if they are new, or if their nodes have moved so far that the
//   linearisation or the weight by the kernel no longer holds (fluid relinearisation of Kaess et al.,
//   "iSAM2", IJRR 2012).
// - Leaves are moved only if a core node that they depend on has moved noticeably.
//
// Complete solutions follow at intervals, and whenever the steps do not lower the error sum as predicted.
// Between them the error sum exceeds its minimum by less than 0.1 % in all measurements, and nodes are a few
// millimetres off, at worst 2 cm in a building of 5 km of path (share/doc/scale.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pose_graph/condensed_equations.h"
#include "pose_graph/node_star.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Result of an optimisation. "Nodes" counts work: it includes a node once for each time.
struct IncrementalReport {
  bool complete = false;             ///< whether the whole graph was solved
  int iterations = 0;                ///< number of steps
  std::size_t linearized_nodes = 0;  ///< number of nodes whose constraints were linearised
  std::size_t placed_nodes = 0;      ///< number of nodes whose pose was computed
  std::size_t core_nodes = 0;        ///< number of core nodes of the graph
  double robust_chi2 = 0;            ///< error sum E with the kernels, after the last step
};

class IncrementalPoseAdjustment {
 public:
  /// Moves the poses of the graph close to a minimum of the robust error sum. A complete solution is that of
  /// `solver`. Other solutions end when the second-order terms of no constraint exceed 0.002 standard
  /// deviations and the weights by the kernels are accurate to 0.02, or earlier if a step lowers the error
  /// sum by less than 1e-4 of it; the next call then goes on. Leaves follow core nodes to 0.5 mm and 5e-5
  /// rad. Headings are in (-pi, pi]. The kernels are those of `solver`. Equal sequences of calls give equal
  /// results to the last bit. Throws unreachable_node(), a UserError, if a node is not linked to the root.
  ///
  /// Solves completely if the graph has grown by a quarter since the last complete solution, or if anything
  /// but new nodes and constraints has changed: poses, the root, or constraints switched on or off.
  IncrementalReport optimize(PoseGraph& graph, SparsePoseAdjustment& solver);

  /// Solves the whole graph with `solver`.
  IncrementalReport optimize_completely(PoseGraph& graph, SparsePoseAdjustment& solver);

 private:
  bool continues(const PoseGraph& graph) const;
  bool add_news(const PoseGraph& graph);
  void add_constraint(const PoseGraph& graph, std::uint32_t index);
  void make_core(std::uint32_t node, const PoseGraph& graph);
  void retire(std::uint32_t centre, const PoseGraph& graph);
  bool linearize(const PoseGraph& graph, const PoseAdjustmentOptions& options, bool reorder = false);
  bool take_steps(const PoseGraph& graph, const PoseAdjustmentOptions& options, IncrementalReport& report);
  void move_core();
  std::vector<std::uint32_t> stars_of_moved_nodes(std::vector<std::uint32_t> stars);
  void place(const std::vector<std::uint32_t>& stars, const PoseGraph& graph,
             const PoseAdjustmentOptions& options);
  NodeStar::Fit enter_fit(std::uint32_t centre, const PoseGraph& graph, const PoseAdjustmentOptions& options);
  bool is_leaf(std::uint32_t node) const;
  void give_pose(std::uint32_t node, PoseGraph& graph) const;

  // What is known of the graph:
  std::size_t root_ = 0;
  std::vector<RotatedPose> poses_;
  std::vector<char> enabled_;
  std::size_t nodes_at_complete_solution_ = 0;

  // Each enabled constraint is part of the star of one of its nodes. That of a leaf has all its constraints.
  std::vector<NodeStar> stars_;         // one for each node
  std::vector<double> costs_;           // error sum of each star
  double cost_ = 0;                     // sum of costs_
  std::vector<std::uint32_t> retired_;  // stars to be linearised; their terms are not in equations_
  std::vector<char> is_retired_;

  CondensedEquations equations_;            // of the core nodes without the root
  std::vector<std::uint32_t> variable_of_;  // variable of each node; NodeStar::kNoVariable: leaf or root
  struct CoreNode {
    std::uint32_t node = 0;
    std::vector<std::uint32_t> stars;  // with constraints of this node
    RotatedPose placed;                // pose for which the leaves were last placed
  };
  std::vector<CoreNode> core_;         // one for each variable
  std::vector<std::uint32_t> placed_;  // leaves whose pose was computed; the graph does not have it yet
  std::vector<char> is_moved_;         // scratch of stars_of_moved_nodes()
};

}  // namespace psi_slam
