// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/extended_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "map/rendering/cell_masks.h"
#include "map/rendering/grid_layout.h"
#include "map/rendering/map_image.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

// With the tolerance at both ends, a hole of less than 0.45 m in a wall that stands: narrower than a doorway,
// and as wide as grazing beams tear.
constexpr double kLeastOpening_m = 0.15;

GridLayout layout_of(const COccupancyGridMap2D& map, double resolution_m) {
  const auto first_cell = [&](float corner_m) -> std::int64_t {
    return std::llround(static_cast<double>(corner_m) / resolution_m);
  };
  return {resolution_m, first_cell(map.getXMin()), first_cell(map.getYMin()),
          static_cast<std::int64_t>(map.getSizeX()), static_cast<std::int64_t>(map.getSizeY())};
}

/// The cells of a map within the cells of both maps.
struct MapCells {
  MapCells(const COccupancyGridMap2D& map, const GridLayout& both)
      : values(static_cast<int>(both.height), static_cast<int>(both.width), std::int8_t{0}) {
    const GridLayout layout = layout_of(map, both.resolution_m);
    for (std::int64_t y = 0; y < layout.height; ++y)
      std::copy_n(map.getRow(static_cast<int>(y)), layout.width,
                  values[static_cast<int>(y + layout.y_min - both.y_min)] + (layout.x_min - both.x_min));
    wall = mask(values < int{kFirstNotOccupiedCell});
    free = mask(values >= int{kFirstFreeCell});
  }

  cv::Mat_<std::int8_t> values;  ///< 0: unknown
  cv::Mat1b wall;
  cv::Mat1b free;
};

/// Returns `cells` without the pieces that adjoin a cell of `standing` and are too short for an opening.
cv::Mat1b without_holes(const cv::Mat1b& cells, const cv::Mat1b& standing, double resolution_m) {
  cv::Mat1i label;
  cv::Mat1i extent;
  cv::Mat centres;
  const int labels = cv::connectedComponentsWithStats(cells, label, extent, centres, 8, CV_32S);
  cv::Mat1b beside_standing;
  cv::dilate(standing, beside_standing, cv::Mat1b(3, 3, std::uint8_t{1}));
  std::vector<bool> adjoins(static_cast<std::size_t>(labels));
  for (int y = 0; y < cells.rows; ++y)
    for (int x = 0; x < cells.cols; ++x)
      if (beside_standing(y, x) != 0) adjoins[static_cast<std::size_t>(label(y, x))] = true;
  const double least_cells = kLeastOpening_m / resolution_m - kRounding_cells;
  cv::Mat1b openings = empty_mask(cells.rows, cells.cols);
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      const int piece = label(y, x);
      if (piece == 0) continue;
      const int side = std::max(extent(piece, cv::CC_STAT_WIDTH), extent(piece, cv::CC_STAT_HEIGHT));
      if (side >= least_cells || !adjoins[static_cast<std::size_t>(piece)]) openings(y, x) = 255;
    }
  }
  return openings;
}

/// Returns the `changed` cells and the `further` ones within the tolerance of them.
cv::Mat1b with_ends(const cv::Mat1b& changed, const cv::Mat1b& further, double tolerance_cells) {
  return mask(changed | (further & (distance_from(changed) <= tolerance_cells)));
}

/// Returns the walls of the prior map that the run sees through.
cv::Mat1b vanished_walls(const MapCells& prior, const MapCells& run, double tolerance_cells,
                         double resolution_m) {
  const cv::Mat1f distance = distance_from(run.wall);
  const cv::Mat1b standing = mask(prior.wall & (distance <= tolerance_cells));
  const cv::Mat1b gone =
      without_holes(mask(prior.wall & (distance > tolerance_cells) & clear_cells(run.free, tolerance_cells)),
                    standing, resolution_m);
  return with_ends(gone, mask(prior.wall & run.free & (distance > tolerance_cells / 2)), tolerance_cells);
}

/// Returns the walls of the run that are new. `remaining` are the walls of the prior map that have not
/// vanished.
cv::Mat1b appeared_walls(const MapCells& prior, const cv::Mat1b& remaining, const MapCells& run,
                         double tolerance_cells) {
  const cv::Mat1b appeared = mask(run.wall & (distance_from(remaining) > tolerance_cells));
  return with_ends(appeared, mask(run.wall & (prior.values == 0)), tolerance_cells);
}

}  // namespace

COccupancyGridMap2D::Ptr extended_map(const COccupancyGridMap2D& prior, const COccupancyGridMap2D& run,
                                      double tolerance_m) {
  const auto resolution_m = static_cast<double>(prior.getResolution());
  if (std::abs(resolution_m - static_cast<double>(run.getResolution())) > 1e-6 * resolution_m)
    throw std::invalid_argument("extended_map: the maps have cells of different sizes");
  const GridLayout a = layout_of(prior, resolution_m);
  const GridLayout b = layout_of(run, resolution_m);
  GridLayout both{resolution_m, std::min(a.x_min, b.x_min), std::min(a.y_min, b.y_min), 0, 0};
  both.width = std::max(a.x_min + a.width, b.x_min + b.width) - both.x_min;
  both.height = std::max(a.y_min + a.height, b.y_min + b.height) - both.y_min;
  MapCells before(prior, both);
  const MapCells now(run, both);
  const double tolerance_cells = tolerance_m / resolution_m + kRounding_cells;
  const cv::Mat1b vanished = vanished_walls(before, now, tolerance_cells, resolution_m);
  const cv::Mat1b appeared = appeared_walls(before, mask(before.wall & ~vanished), now, tolerance_cells);
  const cv::Mat1b undecided = mask(~before.wall & ~before.free);
  const cv::Mat1b unknown = mask(before.values == 0);
  now.values.copyTo(before.values,
                    mask(vanished | appeared | (undecided & now.free) | (unknown & ~now.wall)));
  COccupancyGridMap2D::Ptr map = unknown_grid(both);
  for (int y = 0; y < before.values.rows; ++y)
    std::copy_n(before.values[y], before.values.cols, map->getRow(y));
  return map;
}

}  // namespace psi_slam
