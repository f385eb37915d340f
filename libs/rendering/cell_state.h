// SPDX-License-Identifier: BSD-3-Clause
// When a cell of the gridmap is a wall and when free space: beyond the thresholds of map_server.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

namespace psi_slam {

inline bool is_occupied(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return mrpt::maps::COccupancyGridMap2D::l2p(cell) < 0.35F;
}
inline bool is_free(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return mrpt::maps::COccupancyGridMap2D::l2p(cell) > 0.804F;
}

}  // namespace psi_slam
