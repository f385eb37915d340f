// SPDX-License-Identifier: BSD-3-Clause
// The grid map as a PNG picture that prints true to scale: the file states its pixels per metre of paper.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <optional>
#include <string>

namespace psi_slam {

struct MapPrintOptions {
  double scale = 100;  ///< one metre of paper shows this many metres of the map
  int dpi = 300;       ///< pixels per inch of paper
  /// Limit of the picture's size, so that it does not exhaust the memory. A larger picture gets fewer pixels
  /// per inch at the same scale.
  std::size_t max_pixels = 150'000'000;
  std::optional<double> north_rad;  ///< direction of north in the map, counter-clockwise from the x axis
};

/// Returns the contents of the PNG file: the part of the grid that was seen, and below it a strip with scale
/// bar, axes and north. Equal grids give equal bytes. Throws SystemFailure if the picture cannot be encoded.
std::string print_map(const mrpt::maps::COccupancyGridMap2D& grid, const MapPrintOptions& options = {});

}  // namespace psi_slam
