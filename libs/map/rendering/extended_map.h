// SPDX-License-Identifier: BSD-3-Clause
// Extends a map by what another map in the same frame shows beyond it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

namespace psi_slam {

/// Returns a map that covers both maps. Its cells are those of `prior` where `prior` knows them, and those of
/// `further` elsewhere. Throws std::invalid_argument if the maps have cells of different sizes.
mrpt::maps::COccupancyGridMap2D::Ptr extended_map(const mrpt::maps::COccupancyGridMap2D& prior,
                                                  const mrpt::maps::COccupancyGridMap2D& further);

}  // namespace psi_slam
