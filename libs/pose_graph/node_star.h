// SPDX-License-Identifier: BSD-3-Clause
// The linearised constraints of one node, the centre: its share of the normal equations (equation 6). If the
// centre has constraints in no other star, its pose is eliminated (Schur complement). The star then adds
// terms only for the nodes at the other ends of its constraints.
//
// The star stays linearised at the poses of its last linearize() while the nodes move. add_to() gives the
// terms at the present poses, and fit() tells whether the linearisation still holds there.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pose_graph/condensed_equations.h"
#include "pose_graph/constraint_error.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

class NodeStar {
 public:
  /// Variable of a node without one in CondensedEquations: a node that is held or eliminated.
  static constexpr std::uint32_t kNoVariable = 0xffffffff;

  explicit NodeStar(std::uint32_t centre) : centre_(centre) {}

  /// Adds a constraint of the centre, by its number. linearize() must follow.
  void add(const PoseGraph& graph, std::uint32_t constraint);

  /// Linearises the constraints at `poses`, with weights by their kernels. Eliminates the centre if
  /// `eliminate` is true. Returns false if the constraints do not determine the centre, so that it cannot be
  /// eliminated.
  bool linearize(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                 const PoseAdjustmentOptions& options, bool eliminate);

  /// Decrease of the linearised error sum when the eliminated centre alone moves to its minimum.
  double decrease_by_elimination() const { return eliminated_ ? reduced_gradient_.squaredNorm() : 0; }

  /// Makes room in the equations for the blocks of this star. `variable_of` has one entry per node.
  void link(const std::vector<std::uint32_t>& variable_of, CondensedEquations& equations) const;

  /// Adds H and g of the linearised constraints at `poses` to the equations, multiplied by `sign`.
  void add_to(CondensedEquations& equations, double sign, const PoseGraph& graph,
              const std::vector<RotatedPose>& poses, const std::vector<std::uint32_t>& variable_of) const;

  /// Pose of the eliminated centre that minimises the linearised error sum for `poses` of the other nodes.
  /// Its sine and cosine are computed only if a constraint of this star begins at the centre.
  RotatedPose centre_pose(const std::vector<RotatedPose>& poses) const;

  struct Fit {
    double cost = 0;        ///< error sum of the constraints, with their kernels
    bool is_linear = true;  ///< whether the linearisation is accurate at these poses
  };
  /// Fit of the constraints at `poses`.
  Fit fit(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
          const PoseAdjustmentOptions& options) const;

 private:
  // A linearised constraint. Only what places the centre is stored, because an optimisation takes much of its
  // time to read the ends of many stars.
  struct End {
    std::uint32_t constraint = 0;
    std::uint32_t node = 0;                           // at the other end of the constraint
    double weight = 1;                                // by the kernel
    Eigen::Vector3d at = Eigen::Vector3d::Zero();     // pose (x, y, theta) of `node`
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // block (centre, node) of H, see reduced_gradient_
  };

  ConstraintNormals normals(const End& end, const Constraint& constraint) const;
  Eigen::Vector3d reduced_gradient(const std::vector<RotatedPose>& poses) const;

  std::uint32_t centre_;
  std::vector<End> ends_;
  bool begins_constraint_ = false;  // whether a constraint begins at the centre
  bool eliminated_ = false;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();  // pose of the centre where the constraints are linearised
  // Entry of the centre of g, and block (centre, centre) of H. If the centre is eliminated, the entry of g
  // and the blocks `cross` are multiplied by L^-1, and diagonal_ is L^-1, where L L^T is the block of H.
  Eigen::Vector3d reduced_gradient_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d diagonal_ = Eigen::Matrix3d::Zero();
};

}  // namespace psi_slam
