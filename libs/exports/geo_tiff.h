// SPDX-License-Identifier: BSD-3-Clause
// The gridmap as a GeoTIFF, for geographic information systems.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

namespace psi_slam {

/// Where the map lies on the earth: the place of its origin in a projected coordinate system, and its turn.
struct GeoReference {
  int epsg = 0;  ///< the system's number; 0: a system of the map's own, in metres
  double easting_m = 0;
  double northing_m = 0;
  double heading_rad = 0;  ///< of the map's x axis, counter-clockwise from east
};

/// Throws UserError, a sentence, unless `epsg` is 0 or the number of a projected system in metres.
void check_epsg(int epsg);

/// One band of bytes: how likely a cell is occupied, 0 to 100 percent; 255 where nothing was seen. Throws
/// SystemFailure when it cannot be written, and as check_epsg().
void write_geo_tiff(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                    const GeoReference& reference = {});

}  // namespace psi_slam
