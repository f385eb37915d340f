// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/extended_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "map/rendering/grid_layout.h"

namespace psi_slam {

using mrpt::maps::COccupancyGridMap2D;

COccupancyGridMap2D::Ptr extended_map(const COccupancyGridMap2D& prior, const COccupancyGridMap2D& further) {
  const auto resolution_m = static_cast<double>(prior.getResolution());
  if (std::abs(resolution_m - static_cast<double>(further.getResolution())) > 1e-6 * resolution_m)
    throw std::invalid_argument("extended_map: the maps have cells of different sizes");
  const auto first_cell = [&](float corner_m) -> std::int64_t {
    return std::llround(static_cast<double>(corner_m) / resolution_m);
  };
  const auto layout_of = [&](const COccupancyGridMap2D& map) {
    return GridLayout{resolution_m, first_cell(map.getXMin()), first_cell(map.getYMin()),
                      static_cast<std::int64_t>(map.getSizeX()), static_cast<std::int64_t>(map.getSizeY())};
  };
  const GridLayout a = layout_of(prior);
  const GridLayout b = layout_of(further);
  GridLayout both{resolution_m, std::min(a.x_min, b.x_min), std::min(a.y_min, b.y_min), 0, 0};
  both.width = std::max(a.x_min + a.width, b.x_min + b.width) - both.x_min;
  both.height = std::max(a.y_min + a.height, b.y_min + b.height) - both.y_min;
  COccupancyGridMap2D::Ptr map = unknown_grid(both);
  // The prior map comes last, so its cells stay.
  for (const COccupancyGridMap2D* from : {&further, &prior}) {
    const GridLayout layout = layout_of(*from);
    for (std::int64_t y = 0; y < layout.height; ++y) {
      const COccupancyGridMap2D::cellType* row = from->getRow(static_cast<int>(y));
      COccupancyGridMap2D::cellType* target =
          map->getRow(static_cast<int>(y + layout.y_min - both.y_min)) + (layout.x_min - both.x_min);
      for (std::int64_t x = 0; x < layout.width; ++x)
        if (row[x] != 0) target[x] = row[x];
    }
  }
  return map;
}

}  // namespace psi_slam
