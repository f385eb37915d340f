// SPDX-License-Identifier: BSD-3-Clause
// Writes zones that restrict robots: as filter masks of nav2 and as polygons for MRPT's programs.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <string>
#include <vector>

#include "map/rendering/map_edits.h"

namespace psi_slam {

/// Throws UserError if some slow zones have a share of the largest speed and others a speed: one filter of
/// nav2 knows only one of them. Throws UserError if a zone's speed is less than a hundredth of the fastest
/// zone's speed: the values of a mask resolve no smaller one.
void check_zones(const std::vector<MapEdit>& edits);

/// Writes keepout_mask.yaml, speed_mask.yaml, their images, and zones.txt, for the zones among the edits.
/// Leaves out files without a zone. The masks have the cells of `grid`. In a keep-out zone,
/// the value is 100, elsewhere 0. A slow zone has the value for which nav2's speed filter computes the zone's
/// limit, rounded down; the comment in the file states its type, base and multiplier. Where slow zones
/// overlap, the slower one counts. Throws SystemFailure if a file cannot be written, and UserError as
/// check_zones() does.
void write_zone_files(const std::filesystem::path& folder, const mrpt::maps::COccupancyGridMap2D& grid,
                      const std::vector<MapEdit>& edits);

/// Returns zones.txt, a matrix that mrpt::math::CMatrixDouble::loadFromTextFile() reads. Each row is a corner
/// of a polygon: number of the zone from 1; kind, 0 for keep-out, 1 for percent of the largest speed, 2 for
/// m/s; limit; x and y in metres.
std::string zones_text(const std::vector<MapEdit>& edits);

}  // namespace psi_slam
