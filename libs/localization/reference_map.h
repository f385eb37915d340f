// SPDX-License-Identifier: BSD-3-Clause
// A finished map made ready for robots to be found in.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <memory>

#include "local_maps/local_map.h"

namespace psi_slam {

/// All in the map's own frame.
struct ReferenceMap {
  std::shared_ptr<const LocalMap> fine;    ///< of the map's own resolution
  std::shared_ptr<const LocalMap> coarse;  ///< the same in larger cells: a search of all of it is quick there
};

/// The coarse grid's cells are as large as a multiple of the map's can be, at most `search_resolution_m`, and
/// a cell is as occupied as any in it. Evidence is spread by `smoothing_sigma_m` in the fine one.
ReferenceMap make_reference_map(const mrpt::maps::COccupancyGridMap2D& map, double search_resolution_m,
                                double smoothing_sigma_m);

}  // namespace psi_slam
