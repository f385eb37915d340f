// SPDX-License-Identifier: BSD-3-Clause
// Masks for the costmap filters of nav2, as images for its map_server. write_map_server_pair() in map_files.h
// writes maps.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace psi_slam {

/// Writes NAME.pgm and NAME.yaml with the place and the cells of `grid`; `yaml_path` is NAME.yaml. `values`
/// has a value from 0 to 100 for each cell, row by row from the lower left. The mode is scale, with
/// thresholds from which map_server computes exactly these values. The YAML file begins with `comment`.
void write_mask_pair(const std::filesystem::path& yaml_path, const mrpt::maps::COccupancyGridMap2D& grid,
                     const std::vector<std::uint8_t>& values, const std::string& comment);

}  // namespace psi_slam
