// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pose graph: the poses of the nodes, and the measured relative poses between them (equations 3 to 6).
///
/// The graph uses flat arrays, because MRPT's CNetworkOfPoses2DInf cannot store the kind, the kernel and the
/// on/off state of an edge. The deciders for MRPT's graph-slam engine convert between the two types.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace psi_slam {

/// Robust kernel: a constraint adds the cost rho(s) to the error sum instead of its squared error s = e^T
/// Omega e. The kernel limits the effect of a false constraint on the map. All kernels
/// approach rho(s) = s for small s.
struct RobustKernel {
  /// Form of the cost function.
  enum class Type {
    kNone,            ///< rho(s) = s
    kHuber,           ///< rho(s) grows as sqrt(s) beyond the width; convex in the error
    kCauchy,          ///< rho(s) grows logarithmically
    kDynamicScaling,  ///< dynamic covariance scaling (Agarwal et al., ICRA 2013): bounded by 3 width^2
    kGemanMcClure,    ///< rho(s) is bounded by width^2; for graduated non-convexity (Yang et al., RA-L 2020)
  };

  Type type = Type::kNone;  ///< form of the cost function
  double width = 1;         ///< width of the kernel, > 0, in the unit of sqrt(e^T Omega e)

  /// Returns rho(chi2) for chi2 >= 0.
  double cost(double chi2) const;

  /// Returns drho/dchi2, in [0, 1]: the factor on the information matrix in iteratively reweighted least
  /// squares.
  double weight(double chi2) const;
};

/// One measured relative pose between two nodes of a pose graph: one edge, one term of equation 5.
struct Constraint {
  /// Origin of the measurement.
  enum class Kind {
    kOdometry,  ///< odometry between successive nodes
    kLocalMap,  ///< of the path: from the first node of a path segment to a later node
    kRunStart,  ///< from a node of an earlier run to the first node of a later run
    kLoop,      ///< from a loop closure; can be entirely false
    kKnown,     ///< from what is known from outside, see FixedKnowledge; can be entirely false
  };

  std::size_t from = 0;           ///< node in whose frame `to` is measured
  std::size_t to = 0;             ///< node whose pose is measured
  mrpt::math::TPose2D from_T_to;  ///< measured pose of `to` in the frame of `from`: metres, radians
  /// Inverse covariance of (x, y, theta) of from_T_to, in the axes of `from`: 1/m^2, 1/(m rad), 1/rad^2.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  /// Covariance to add where places are searched and loops are chosen, in the same axes: errors that may
  /// repeat along the path, and then add up. See doubtful_graph().
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();
  Kind kind = Kind::kOdometry;         ///< origin of the measurement
  std::optional<RobustKernel> kernel;  ///< kernel of this constraint; empty: the solver's kernel for its kind
};

/// Symmetric 3x3 covariance of (x, y, theta): m^2, m rad, rad^2.
struct PoseCovariance {
  double xx = 0;  ///< variance of x, m^2
  double xy = 0;  ///< covariance of x and y, m^2
  double xt = 0;  ///< covariance of x and theta, m rad
  double yy = 0;  ///< variance of y, m^2
  double yt = 0;  ///< covariance of y and theta, m rad
  double tt = 0;  ///< variance of theta, rad^2
};

/// Ends and covariance of a constraint, stored compactly for graph searches.
struct GraphLink {
  std::uint32_t from = 0;  ///< node where the constraint begins
  std::uint32_t to = 0;    ///< node where the constraint ends
  /// Covariance of from_T_to along the axes of `from`. The variances are infinite if the information is
  /// singular.
  PoseCovariance covariance;
  PoseCovariance doubt;  ///< Constraint::doubt
};

/// Graph of nodes and constraints, both numbered from 0 in the order of insertion. Nodes and constraints are
/// never removed, but constraints can be switched off. The solver keeps the pose of the root fixed, which is
/// node 0 unless set_root() changes it. Functions throw std::out_of_range for an index that does not exist.
class PoseGraph {
 public:
  /// Adds a node and returns its number. Throws std::invalid_argument if the pose is not finite.
  std::size_t add_node(const mrpt::math::TPose2D& map_T_node);

  /// Adds a constraint, switched on, and returns its number. Throws std::invalid_argument if it links a node
  /// to itself, if its pose is not finite, or if its information is not symmetric and positive semi-definite.
  std::size_t add_constraint(const Constraint& constraint);

  /// Switches a constraint on or off. Solvers and searches ignore a constraint that is off. The numbers of
  /// all constraints stay valid.
  void set_enabled(std::size_t constraint, bool enabled) { enabled_.at(constraint) = enabled ? 1 : 0; }
  /// Returns whether a constraint is switched on.
  bool enabled(std::size_t constraint) const { return enabled_.at(constraint) != 0; }

  /// Chooses the node whose pose the solver keeps fixed.
  void set_root(std::size_t node);
  /// Number of the node whose pose the solver keeps fixed.
  std::size_t root() const { return root_; }

  /// Number of nodes.
  std::size_t num_nodes() const { return poses_.size(); }
  /// Number of constraints, enabled or not.
  std::size_t num_constraints() const { return constraints_.size(); }
  /// Number of constraints that are switched on.
  std::size_t num_enabled_constraints() const;

  /// Pose of a node in the map frame: metres, radians in (-pi, pi].
  const mrpt::math::TPose2D& pose(std::size_t node) const { return poses_.at(node); }
  /// Sets the pose of a node and wraps its heading to (-pi, pi]. Throws std::invalid_argument if the pose is
  /// not finite.
  void set_pose(std::size_t node, const mrpt::math::TPose2D& map_T_node);
  /// Poses of all nodes in the map frame.
  const std::vector<mrpt::math::TPose2D>& poses() const { return poses_; }

  /// Returns a constraint by its number.
  const Constraint& constraint(std::size_t index) const { return constraints_.at(index); }
  /// All constraints, enabled or not.
  const std::vector<Constraint>& constraints() const { return constraints_; }
  /// One link per constraint, enabled or not, with the same index.
  const std::vector<GraphLink>& links() const { return links_; }
  /// Numbers of the constraints that begin or end at a node, enabled or not, in the order of insertion.
  const std::vector<std::uint32_t>& constraints_of(std::size_t node) const { return incident_.at(node); }

  /// Returns the sum of e^T Omega e over the enabled constraints: E of equation 5 without robust kernels.
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
