// SPDX-License-Identifier: BSD-3-Clause
// The gridmap as a picture that prints true to scale: a PNG file that says how many of its pixels make a
// metre of paper.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <optional>
#include <string>

namespace psi_slam {

struct MapPrintOptions {
  double scale = 100;  ///< a metre of paper shows so many metres
  int dpi = 300;       ///< pixels an inch of paper
  /// A larger picture gets fewer pixels an inch, at the same scale: it shall not exhaust the memory.
  std::size_t max_pixels = 150'000'000;
  /// The direction of north in the map, where it is known, counter-clockwise from the x axis.
  std::optional<double> north_rad;
};

struct MapPrint {
  std::string png;
  int dpi = 0;            ///< as written
  double pixels_a_m = 0;  ///< of the building
  int map_height_px = 0;  ///< the map; the strip with scale bar and axes is below it
  int width_px = 0;
  int height_px = 0;
  double x_min_m = 0;  ///< of the picture's upper left corner, in the map
  double y_max_m = 0;
};

/// The part of the grid that was seen. The same grid gives the same bytes.
MapPrint print_map(const mrpt::maps::COccupancyGridMap2D& grid, const MapPrintOptions& options = {});

}  // namespace psi_slam
