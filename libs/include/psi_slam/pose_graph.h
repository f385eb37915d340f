// SPDX-License-Identifier: BSD-3-Clause
// The pose graph: the poses of the nodes and the measured relative poses between them.
//
// It keeps both in flat arrays and makes MRPT's CNetworkOfPoses2DInf of them on request (mrpt_network.h)
// instead of keeping one in step: that container holds one tree or hash node an edge, has no place for an
// edge's kind, kernel or switch, and cannot tell apart two edges of the same pair of nodes, while the solver
// and the path search walk all edges hundreds of times a run.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pose_graph/constraint.h"

namespace psi_slam {

/// The part of a constraint that searches over the graph read, packed for them.
struct GraphLink {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  /// Covariance of from_T_to in the axes of `from`; the inverse of the information, infinite where that is
  /// singular.
  double xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0;
};

/// Nodes are 0 .. num_nodes() - 1 and constraints 0 .. num_constraints() - 1 in the order of their insertion;
/// neither is ever removed, but a constraint can be switched off. The root's pose is held by the solver; it
/// is node 0 unless set_root() says otherwise. An index that does not exist throws std::out_of_range.
class PoseGraph {
 public:
  /// Adds a node and returns its number. Throws std::invalid_argument when the pose is not finite.
  std::size_t add_node(const mrpt::math::TPose2D& map_T_node);

  /// Adds a constraint, switched on, and returns its number. Throws std::invalid_argument when it links a
  /// node to itself, or its pose is not finite, or its information not symmetric and positive semi-definite.
  std::size_t add_constraint(const Constraint& constraint);

  /// A constraint that is switched off takes no part in anything but keeps its number.
  void set_enabled(std::size_t constraint, bool enabled) { enabled_.at(constraint) = enabled ? 1 : 0; }
  bool enabled(std::size_t constraint) const { return enabled_.at(constraint) != 0; }

  void set_root(std::size_t node);
  std::size_t root() const { return root_; }

  std::size_t num_nodes() const { return poses_.size(); }
  std::size_t num_constraints() const { return constraints_.size(); }
  std::size_t num_enabled_constraints() const;

  const mrpt::math::TPose2D& pose(std::size_t node) const { return poses_.at(node); }
  /// The heading is wrapped to (-pi, pi]. Throws std::invalid_argument when the pose is not finite.
  void set_pose(std::size_t node, const mrpt::math::TPose2D& map_T_node);
  const std::vector<mrpt::math::TPose2D>& poses() const { return poses_; }

  const Constraint& constraint(std::size_t index) const { return constraints_.at(index); }
  const std::vector<Constraint>& constraints() const { return constraints_; }
  /// One for each constraint, enabled or not.
  const std::vector<GraphLink>& links() const { return links_; }
  /// The constraints that begin or end at a node, enabled or not, in the order of their insertion.
  const std::vector<std::uint32_t>& constraints_of(std::size_t node) const { return incident_.at(node); }

  /// Sum of e^T Omega e over the enabled constraints: the E of equation 5 without robust kernels.
  double chi2() const;

 private:
  std::vector<mrpt::math::TPose2D> poses_;
  std::vector<std::vector<std::uint32_t>> incident_;
  std::vector<Constraint> constraints_;
  std::vector<GraphLink> links_;
  std::vector<char> enabled_;
  std::size_t root_ = 0;
};

}  // namespace psi_slam
