// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/grid_layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

/// Change of a cell's log-odds by one pass, in MRPT's units of 1/16 nat. After one pass, a cell is free with
/// probability 0.82; after one hit, it is occupied with probability 0.99.
constexpr int kLogOddsOfOnePass = 24;

}  // namespace

GridLayout layout_for(const mrpt::math::TBoundingBox& bounds, const GridMapOptions& options) {
  constexpr double kMinMarginCells = 2;  // the digital line of a ray may end one cell beside the end point
  for (double resolution_m = options.resolution_m;; resolution_m *= 2) {
    const double margin = std::max(options.margin_m / resolution_m, kMinMarginCells);
    const double x_min = std::floor(bounds.min.x / resolution_m - margin);
    const double y_min = std::floor(bounds.min.y / resolution_m - margin);
    const double width = std::ceil(bounds.max.x / resolution_m + margin) - x_min;
    const double height = std::ceil(bounds.max.y / resolution_m + margin) - y_min;
    if (width * height > static_cast<double>(options.max_cells) && width * height > 100) continue;
    return {resolution_m, std::llround(x_min), std::llround(y_min), std::llround(width),
            std::llround(height)};
  }
}

COccupancyGridMap2D::Ptr unknown_grid(const GridLayout& layout) {
  auto grid = COccupancyGridMap2D::Create();
  const double r = layout.resolution_m;
  const auto edge = [r](std::int64_t cell) { return static_cast<float>(static_cast<double>(cell) * r); };
  grid->setSize(edge(layout.x_min), edge(layout.x_min + layout.width), edge(layout.y_min),
                edge(layout.y_min + layout.height), static_cast<float>(r), 0.5F);
  if (grid->getSizeX() != layout.width || grid->getSizeY() != layout.height)
    throw std::logic_error("draw_grid_map: MRPT made a grid of another size than requested");
  return grid;
}

COccupancyGridMap2D::cellType cell_value(std::int64_t evidence) {
  return static_cast<COccupancyGridMap2D::cellType>(
      std::clamp<std::int64_t>(-evidence * kLogOddsOfOnePass, COccupancyGridMap2D::OCCGRID_CELLTYPE_MIN,
                               COccupancyGridMap2D::OCCGRID_CELLTYPE_MAX));
}

void check_drawable(const GridMapOptions& options) {
  if (!(options.resolution_m > 0) || !(options.max_range_m > 0) || !(options.no_return_clears_m >= 0) ||
      !(options.margin_m >= 0))
    throw std::invalid_argument(
        "draw_grid_map: resolution_m and max_range_m must be positive, no_return_clears_m and margin_m must "
        "not be negative");
  if (options.min_beams < 1 || options.min_beams > 3)
    throw std::invalid_argument("draw_grid_map: min_beams is " + std::to_string(options.min_beams) +
                                ", expected 1 to 3");
}

}  // namespace psi_slam
