// SPDX-License-Identifier: BSD-3-Clause
// The grid map as files for map_server of ROS 1 and nav2: a PGM image and a YAML file that names it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

namespace psi_slam {

/// Writes NAME.pgm (binary P5, row 0 on top; 0 occupied, 254 free, 205 unknown) and NAME.yaml (mode trinary,
/// origin at the lower left corner, in metres in the map) for `yaml_path` NAME.yaml. Writes the image first,
/// so the pair is complete once the YAML file exists. Throws SystemFailure if a file cannot be written.
void write_map_server_pair(const std::filesystem::path& yaml_path,
                           const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
