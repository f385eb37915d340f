// SPDX-License-Identifier: BSD-3-Clause
// The gridmap as map_server of ROS 1 and nav2 load it: a PGM image and a YAML file that names it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

namespace psi_slam {

/// Writes NAME.pgm (binary P5, row 0 on top; 0 occupied, 254 free, 205 unknown) and NAME.yaml (mode trinary;
/// its origin is the map position of the lower left corner) for `yaml_path` NAME.yaml. The image comes first:
/// when the YAML file is there, the pair is whole. Throws SystemFailure when they cannot be written.
void write_map_server_pair(const std::filesystem::path& yaml_path,
                           const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
