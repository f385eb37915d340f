// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "pose_graph/robust_kernel.h"

namespace psi_slam {

/// One measured relative pose between two nodes of a pose graph: an edge of the graph, one term of
/// equation 5.
struct Constraint {
  enum class Kind {
    kOdometry,    ///< between successive nodes
    kLocalMap,    ///< of a node to the anchor of a local map that holds its scan
    kRunStart,  ///< about where a drive begins, seen from a node of another one
    kLoop,        ///< found by recognising a place: the only kind that may be wrong altogether
  };

  std::size_t from = 0;
  std::size_t to = 0;
  mrpt::math::TPose2D from_T_to;  ///< metres, radians
  /// Inverse covariance of (x, y, theta) of from_T_to, x and y along the axes of `from`: 1/m^2, 1/(m rad),
  /// 1/rad^2.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  Kind kind = Kind::kOdometry;
  std::optional<RobustKernel> kernel;  ///< instead of the one that the solver has for its kind
};

}  // namespace psi_slam
