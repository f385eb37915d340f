// SPDX-License-Identifier: BSD-3-Clause
// Maps as images for map_server of ROS 1 and nav2, and masks for the costmap filters of nav2.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace psi_slam {

/// Writes NAME.pgm and NAME.yaml, as map_server of ROS 1 and nav2 read them; `yaml_path` is NAME.yaml. The
/// image is binary (P5) with row 0 on top: 0 occupied, 254 free, 205 unknown. The YAML file states mode
/// trinary and the lower left corner as origin, in metres in the map. Writes the image first, so the pair is
/// complete once the YAML file exists.
void write_map_server_pair(const std::filesystem::path& yaml_path,
                           const mrpt::maps::COccupancyGridMap2D& grid);

/// Writes NAME.pgm and NAME.yaml with the place and the cells of `grid`; `yaml_path` is NAME.yaml. `values`
/// has a value from 0 to 100 for each cell, row by row from the lower left. The mode is scale, with
/// thresholds from which map_server computes exactly these values. The YAML file begins with `comment`.
void write_mask_pair(const std::filesystem::path& yaml_path, const mrpt::maps::COccupancyGridMap2D& grid,
                     const std::vector<std::uint8_t>& values, const std::string& comment);

}  // namespace psi_slam
