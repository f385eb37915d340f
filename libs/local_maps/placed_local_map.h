// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "local_maps/local_map.h"

namespace psi_slam {

/// A local map with its place on the robot's path. Shared between the front end, which fills it, and loop
/// closing.
struct PlacedLocalMap {
  std::size_t id = 0;               ///< they count from 0 in the order of their beginning
  std::size_t anchor = 0;           ///< the node it began with, whose pose is its frame
  mrpt::math::TPose2D local_T_map;  ///< the anchor's pose in the front end's frame
  std::size_t first_node = 0;       ///< the nodes whose scans it holds: [first_node, last_node]
  std::size_t last_node = 0;
  double travelled_m = 0;  ///< by the robot while it was filled
  /// Of the robot's pose in this map while it is active: x, y (m^2) and heading (rad^2), along the map's
  /// axes.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::shared_ptr<LocalMap> map;
};

}  // namespace psi_slam
