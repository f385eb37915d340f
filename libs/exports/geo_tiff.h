// SPDX-License-Identifier: BSD-3-Clause
// The grid map as a GeoTIFF file for geographic information systems.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

namespace psi_slam {

/// Pose of the map's frame in a projected coordinate system.
struct GeoReference {
  int epsg = 0;  ///< number of the coordinate system; 0 for a local system in metres
  double easting_m = 0;
  double northing_m = 0;
  double heading_rad = 0;  ///< of the map's x axis, counter-clockwise from east
};

/// Throws UserError unless `epsg` is 0 or the number of a projected coordinate system in metres.
void check_epsg(int epsg);

/// Writes one band of bytes atomically: the probability of occupied space in percent, 255 where nothing was
/// seen. Throws SystemFailure if the file cannot be written, UserError as check_epsg().
void write_geo_tiff(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                    const GeoReference& reference = {});

}  // namespace psi_slam
