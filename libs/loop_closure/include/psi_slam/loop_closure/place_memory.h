// SPDX-License-Identifier: BSD-3-Clause
// What loop closing remembers of the places the robot has been: each node's points and pose in the front
// end's frame, and the finished local maps.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "psi_slam/local_maps/front_end.h"
#include "psi_slam/matching/scan_points.h"

namespace psi_slam {

struct NodeScan {
  std::size_t frame = 0;              ///< in the log's order
  mrpt::math::TPose2D local_T_robot;  ///< in the front end's frame
  double travelled_m = 0;             ///< along the path from the first node to this one
  std::shared_ptr<const ScanPoints> points;
};

struct PlaceMemory {
  std::vector<NodeScan> nodes;             ///< by node number
  std::vector<PlacedLocalMap> local_maps;  ///< finished ones, in the order of their ids
};

}  // namespace psi_slam
