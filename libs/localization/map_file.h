// SPDX-License-Identifier: BSD-3-Clause
// Gridmaps read back from what a run has written.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

namespace psi_slam {

/// Reads `map.yaml`, with the image that it names, or `map.gridmap.gz`: what it is, its name's end tells.
/// Throws UserError, a sentence that names the file, when it cannot be read, is neither, is turned, or shows
/// no wall.
mrpt::maps::COccupancyGridMap2D read_map_file(const std::filesystem::path& path);

}  // namespace psi_slam
