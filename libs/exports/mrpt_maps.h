// SPDX-License-Identifier: BSD-3-Clause
// Maps in MRPT's own formats, gzipped as its tools expect them. The same map gives the same bytes.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>

#include <filesystem>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// The nodes of the graph with their scans: what MRPT calls a simple map. Each pose comes with a covariance
/// of (1 mm)^2 and (1 mrad)^2, a stand-in that MRPT can invert: the marginals of the graph are not computed.
mrpt::maps::CSimpleMap simple_map(const MappingResult& result);

/// Writes `map.simplemap.gz`, loadable by CSimpleMap::loadFromFile and MRPT's programs. Throws SystemFailure.
void write_simple_map(const std::filesystem::path& path, const mrpt::maps::CSimpleMap& map);

/// Writes `map.gridmap.gz`: the serialized grid, as MRPT's programs load it. Throws SystemFailure.
void write_grid_map(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
