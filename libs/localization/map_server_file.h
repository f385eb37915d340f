// SPDX-License-Identifier: BSD-3-Clause
// The YAML file of ROS's map_server (https://wiki.ros.org/map_server) and its image.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <filesystem>
#include <optional>

#include "localization/image_size.h"

namespace psi_slam {

enum class MapImageMode { kTrinary, kScale, kRaw };

/// Contents of a map.yaml.
struct MapServerFile {
  std::filesystem::path image;
  double resolution_m = 0;
  mrpt::math::TPose2D map_T_image;  ///< origin: pose of the image's lower left corner
  bool negate = false;              ///< whether black is free
  double occupied_threshold = 0;
  double free_threshold = 0;
  MapImageMode mode = MapImageMode::kTrinary;
};

/// Reads a map.yaml. An origin of two numbers, or whose yaw is not a number, has yaw 0. Throws UserError that
/// names the key that is missing or wrong.
MapServerFile read_map_server_file(const std::filesystem::path& path);

/// Lower left and upper right corner of a grid in the map, metres.
struct GridCorners {
  mrpt::math::TPoint2D low;
  mrpt::math::TPoint2D high;
};

/// Returns the corners of the grid that grid_of_image() makes of an image of this size: those of the image,
/// or of the rectangle around the turned image and a cell more on each side.
GridCorners corners_of_grid(const MapServerFile& file, const ImageSize& size);

/// Makes a grid map of the image of a map.yaml: probabilities of free space by the rules of map_server,
/// except that pixels with less than half of the opacity are unknown. Images of 8 and 16 bits, grey or
/// coloured. The grid of a turned image has the same resolution; a cell takes the most occupied of four
/// points in it. Empty if OpenCV cannot read the image.
std::optional<mrpt::maps::COccupancyGridMap2D> grid_of_image(const MapServerFile& file);

}  // namespace psi_slam
