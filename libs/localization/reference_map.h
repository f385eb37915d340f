// SPDX-License-Identifier: BSD-3-Clause
// A finished map, prepared for matching.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>

#include <filesystem>
#include <memory>
#include <string>

#include "mapping/local_maps/local_map.h"

namespace psi_slam {

/// Grids of a finished map at two resolutions, both in the frame of the map.
struct ReferenceMap {
  std::shared_ptr<const LocalMap> fine;    ///< grid with the resolution of the map
  std::shared_ptr<const LocalMap> coarse;  ///< grid with larger cells, for fast searches of the whole map
};

/// Blur of the fine grid if the map is measured better than a robot maps, such as a plan.
inline constexpr double kFineSmoothing_m = 0.03;

/// Prepares a map. The cell size of the coarse grid is the largest multiple of the map's cell size up to
/// `search_resolution_m`, but at least one cell. Each coarse cell takes the occupancy of the most occupied
/// known cell in it, and is unknown if all of them are. `smoothing_sigma_m` blurs the scores of the fine
/// grid; the blur of the coarse grid grows with its cells.
ReferenceMap make_reference_map(const mrpt::maps::COccupancyGridMap2D& map, double search_resolution_m,
                                double smoothing_sigma_m);

/// Reads a map from `map.yaml`, with the image that it names, or from `map.gridmap.gz`. The file's extension
/// decides. Throws UserError if the file is unreadable or of another kind, or if the map has no wall.
mrpt::maps::COccupancyGridMap2D read_map_file(const std::filesystem::path& path);

/// A map, and the vector from its place by MRPT to its place by its file, in metres. MRPT moves maps by up to
/// half a cell, so that their corners lie on multiples of the resolution.
struct PlacedMapFile {
  mrpt::maps::COccupancyGridMap2D grid;
  mrpt::math::TPoint2D offset{0, 0};
};

/// Throws UserError if a map with these corners, in metres, lies too far from the origin for the coordinates
/// of grid maps, which are 32-bit floats. `path` names the map.
void check_map_place(const std::filesystem::path& path, const mrpt::math::TPoint2D& low,
                     const mrpt::math::TPoint2D& high);

/// Reads a map like read_map_file(), with its exact place.
PlacedMapFile read_placed_map_file(const std::filesystem::path& path);

/// Returns the SHA-256 of a map's file. For `map.yaml`: SHA-256 of a text with two lines, its own SHA-256 and
/// that of the image that it names. Throws UserError if a file is unreadable.
std::string sha256_of_map_file(const std::filesystem::path& path);

}  // namespace psi_slam
