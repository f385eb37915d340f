// SPDX-License-Identifier: BSD-3-Clause
#include "localization/reference_map.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

// A larger cell is unknown only if all cells in it are unknown.
Grid in_larger_cells(const Grid& map, int factor) {
  const float resolution = map.getResolution() * static_cast<float>(factor);
  Grid larger;
  larger.setSize(map.getXMin() - resolution, map.getXMax() + resolution, map.getYMin() - resolution,
                 map.getYMax() + resolution, resolution, 0.5F);
  for (int y = 0; y < static_cast<int>(map.getSizeY()); ++y) {
    const Grid::cellType* row = map.getRow(y);
    Grid::cellType* larger_row = larger.getRow(larger.y2idx(map.idx2y(y)));
    for (int x = 0; x < static_cast<int>(map.getSizeX()); ++x) {
      Grid::cellType& cell = larger_row[larger.x2idx(map.idx2x(x))];
      cell = cell == 0 ? row[x] : row[x] == 0 ? cell : std::min(cell, row[x]);
    }
  }
  return larger;
}

}  // namespace

ReferenceMap make_reference_map(const Grid& map, double search_resolution_m, double smoothing_sigma_m) {
  const auto resolution_m = static_cast<double>(map.getResolution());
  const int factor = std::max(1, static_cast<int>(std::floor(search_resolution_m / resolution_m + 1e-3)));
  LocalMapOptions options;
  options.smoothing_sigma_m = smoothing_sigma_m;
  ReferenceMap reference;
  reference.fine = std::make_shared<const LocalMap>(options, map);
  options.smoothing_sigma_m = smoothing_sigma_m * factor;
  reference.coarse = std::make_shared<const LocalMap>(options, in_larger_cells(map, factor));
  return reference;
}

}  // namespace psi_slam
