// SPDX-License-Identifier: BSD-3-Clause
// A finished map, prepared for matching.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <memory>

#include "local_maps/local_map.h"

namespace psi_slam {

/// Both grids are in the map's own frame.
struct ReferenceMap {
  std::shared_ptr<const LocalMap> fine;    ///< with the resolution of the map
  std::shared_ptr<const LocalMap> coarse;  ///< with larger cells, so that searching all of it is fast
};

/// The cells of the coarse grid are the largest multiple of the map's cells up to `search_resolution_m`. Each
/// is as occupied as the most occupied cell in it. `smoothing_sigma_m` blurs the fine grid's scores.
ReferenceMap make_reference_map(const mrpt::maps::COccupancyGridMap2D& map, double search_resolution_m,
                                double smoothing_sigma_m);

/// Reads a map from `map.yaml`, with the image that it names, or from `map.gridmap.gz`; the file's extension
/// decides. Throws UserError if the file is unreadable or of another kind, or if the map is rotated or has no
/// wall.
mrpt::maps::COccupancyGridMap2D read_map_file(const std::filesystem::path& path);

}  // namespace psi_slam
