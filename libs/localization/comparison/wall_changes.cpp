// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/wall_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "localization/comparison/moved_walls.h"
#include "logs/frames/pose_operations.h"
#include "map/rendering/cell_masks.h"
#include "map/rendering/map_image.h"
#include "matching/cell.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using Kind = WallChange::Kind;

/// Which cells of the compared area are walls of a map, and which are free. 255: true, 0: false.
struct Layer {
  cv::Mat1b wall;
  cv::Mat1b free;

  cv::Mat1b seen() const { return mask(wall | free); }
};

/// Makes the cells that hold all observed cells of both maps, in the frame and with the cells of map A. Empty
/// if the rectangles around the observed cells of both maps do not overlap: these maps may lie far apart.
std::optional<ComparedCells> layout_of(const Grid& a, const Grid& b, const TPose2D& a_T_b) {
  const SeenCells seen = seen_cells(a);
  int x_begin = std::numeric_limits<int>::max();  // the rectangle around the observed cells of map B
  int x_end = std::numeric_limits<int>::min();
  int y_begin = x_begin;
  int y_end = x_end;
  const auto resolution_m = static_cast<double>(a.getResolution());
  for (int y = 0; y < static_cast<int>(b.getSizeY()); ++y) {
    const Grid::cellType* row = b.getRow(y);
    for (int x = 0; x < static_cast<int>(b.getSizeX()); ++x) {
      if (!is_occupied(row[x]) && !is_free(row[x])) continue;
      const TPoint2D point =
          transform(a_T_b, {static_cast<double>(b.idx2x(x)), static_cast<double>(b.idx2y(y))});
      const int column = floor_to_int((point.x - static_cast<double>(a.getXMin())) / resolution_m);
      const int line = floor_to_int((point.y - static_cast<double>(a.getYMin())) / resolution_m);
      x_begin = std::min(x_begin, column);
      x_end = std::max(x_end, column + 1);
      y_begin = std::min(y_begin, line);
      y_end = std::max(y_end, line + 1);
    }
  }
  if (std::max(x_begin, seen.x_begin) >= std::min(x_end, seen.x_end) ||
      std::max(y_begin, seen.y_begin) >= std::min(y_end, seen.y_end))
    return std::nullopt;
  x_begin = std::min(x_begin, seen.x_begin);
  x_end = std::max(x_end, seen.x_end);
  y_begin = std::min(y_begin, seen.y_begin);
  y_end = std::max(y_end, seen.y_end);
  ComparedCells layout;
  layout.cell_m = resolution_m;
  layout.x_min_m = static_cast<double>(a.getXMin()) + x_begin * resolution_m;
  layout.y_min_m = static_cast<double>(a.getYMin()) + y_begin * resolution_m;
  layout.width = x_end - x_begin;
  layout.height = y_end - y_begin;
  return layout;
}

TPoint2D centre_of(const ComparedCells& layout, double x, double y) {
  return {layout.x_min_m + (x + 0.5) * layout.cell_m, layout.y_min_m + (y + 0.5) * layout.cell_m};
}

/// Reads a map at the centres of the compared cells. A wall between two centres is not lost: each wall cell
/// of the map is also drawn into the cell that holds its own centre.
Layer layer_of(const Grid& map, const TPose2D& a_T_map, const ComparedCells& layout) {
  Layer layer{empty_mask(layout.height, layout.width), empty_mask(layout.height, layout.width)};
  const TPose2D map_T_a = inverse(a_T_map);
  const auto width = static_cast<int>(map.getSizeX());
  const auto height = static_cast<int>(map.getSizeY());
  for (int y = 0; y < layout.height; ++y) {
    for (int x = 0; x < layout.width; ++x) {
      const TPoint2D point = transform(map_T_a, centre_of(layout, x, y));
      const int column = map.x2idx(point.x);
      const int row = map.y2idx(point.y);
      if (column < 0 || column >= width || row < 0 || row >= height) continue;
      const Grid::cellType cell = map.getRow(row)[column];
      layer.wall(y, x) = is_occupied(cell) ? 255 : 0;
      layer.free(y, x) = is_free(cell) ? 255 : 0;
    }
  }
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (!is_occupied(map.getRow(row)[column])) continue;
      const TPoint2D point =
          transform(a_T_map, {static_cast<double>(map.idx2x(column)), static_cast<double>(map.idx2y(row))});
      const int x = static_cast<int>((point.x - layout.x_min_m) / layout.cell_m);
      const int y = static_cast<int>((point.y - layout.y_min_m) / layout.cell_m);
      if (x < 0 || x >= layout.width || y < 0 || y >= layout.height) continue;
      layer.wall(y, x) = 255;
      layer.free(y, x) = 0;
    }
  }
  return layer;
}

/// Returns the cells of `walls` without a wall of `others` within the tolerance.
cv::Mat1b without_counterpart(const cv::Mat1b& walls, const cv::Mat1b& others, double tolerance_cells) {
  return mask(walls & (distance_from(others) > tolerance_cells));
}

std::vector<ChangedWall> walls_in(const cv::Mat1b& cells, double min_length_cells) {
  WallCells found;
  cv::findNonZero(cells, found);
  return connected_walls(found, min_length_cells);
}

cv::Mat1b mask_of(const std::vector<ChangedWall>& walls, const cv::Size& size) {
  cv::Mat1b cells = empty_mask(size.height, size.width);
  for (const ChangedWall& wall : walls)
    for (const cv::Point& cell : wall.cells) cells(cell) = 255;
  return cells;
}

WallChange in_metres(const ChangedWall& wall, Kind kind, const cv::Point2d& shift_cells,
                     const ComparedCells& layout) {
  WallChange result;
  result.kind = kind;
  result.from = centre_of(layout, wall.from.x, wall.from.y);
  result.to = centre_of(layout, wall.to.x, wall.to.y);
  result.length_m = wall.length() * layout.cell_m;
  result.shift = TPoint2D(shift_cells.x, shift_cells.y) * layout.cell_m;
  return result;
}

/// Classifies the changes of two layers and paints them into `cells`.
class Classification {
 public:
  Classification(const Layer& a, const Layer& b, const WallChangeOptions& options, ComparedCells& cells)
      : cells_(cells),
        limits_{options.farthest_move_m / cells.cell_m, options.tolerance_m / cells.cell_m + kRounding_cells,
                options.min_length_m / cells.cell_m},
        only_a_(without_counterpart(a.wall, b.wall, limits_.tolerance)),
        only_b_(without_counterpart(b.wall, a.wall, limits_.tolerance)),
        changed_a_(mask(only_a_ & clear_cells(b.free, limits_.tolerance))),
        changed_b_(mask(only_b_ & clear_cells(a.free, limits_.tolerance))),
        vanished_(walls_in(changed_a_, limits_.min_length)),
        appeared_(walls_in(changed_b_, limits_.min_length)) {
    paint_background(a, b);
    classify();
  }

  std::vector<WallChange> take_changes() { return std::move(found_); }

 private:
  void paint(const cv::Point& cell, ComparedCell value) {
    cells_.cells[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(cells_.width) +
                 static_cast<std::size_t>(cell.x)] = value;
  }

  void paint_background(const Layer& a, const Layer& b) {
    const cv::Mat1b unclear = mask((only_a_ & ~changed_a_) | (only_b_ & ~changed_b_));
    cells_.cells.assign(static_cast<std::size_t>(cells_.width) * static_cast<std::size_t>(cells_.height),
                        ComparedCell::kUnknown);
    for (int y = 0; y < cells_.height; ++y) {
      for (int x = 0; x < cells_.width; ++x) {
        if (unclear(y, x) != 0)
          paint({x, y}, ComparedCell::kWallOfOne);
        else if (a.wall(y, x) != 0 || b.wall(y, x) != 0)
          paint({x, y}, ComparedCell::kWall);
        else if (a.free(y, x) != 0 || b.free(y, x) != 0)
          paint({x, y}, ComparedCell::kFree);
      }
    }
  }

  void add(const ChangedWall& wall, Kind kind, const cv::Point2d& shift = {0, 0}) {
    found_.push_back(in_metres(wall, kind, shift, cells_));
  }

  void classify() {
    // The other place of a moved wall may lie where one map shows too little, beyond another wall.
    const cv::Mat1b hidden_a = mask(only_a_ & ~mask_of(vanished_, only_a_.size()));
    const cv::Mat1b hidden_b = mask(only_b_ & ~mask_of(appeared_, only_b_.size()));
    for (const ChangedWall& wall : vanished_)
      for (const cv::Point& cell : wall.cells) paint(cell, ComparedCell::kVanished);
    for (const ChangedWall& wall : appeared_)
      for (const cv::Point& cell : wall.cells) paint(cell, ComparedCell::kAppeared);
    for (const MovedWall& moved : take_moved_walls(vanished_, appeared_, limits_))
      add(moved.wall, Kind::kMoved, moved.shift);
    for (const ChangedWall& wall : vanished_) {
      const auto shift = shift_to_parallel(wall, hidden_b, limits_);
      add(wall, shift ? Kind::kMoved : Kind::kVanished, shift.value_or(cv::Point2d(0, 0)));
    }
    for (ChangedWall& wall : appeared_) {
      if (const auto back = shift_to_parallel(wall, hidden_a, limits_)) {
        wall.from += *back;
        wall.to += *back;
        add(wall, Kind::kMoved, -*back);
      } else {
        add(wall, Kind::kAppeared);
      }
    }
  }

  ComparedCells& cells_;
  WallMoveLimits limits_;
  cv::Mat1b only_a_;  ///< walls of A that are no walls of B
  cv::Mat1b only_b_;
  cv::Mat1b changed_a_;  ///< walls of A in clear free space of B
  cv::Mat1b changed_b_;
  std::vector<ChangedWall> vanished_;  ///< of changed_a_; after classify() without those that moved
  std::vector<ChangedWall> appeared_;  ///< of changed_b_
  std::vector<WallChange> found_;
};

}  // namespace

WallChanges find_wall_changes(const Grid& a, const Grid& b, const TPose2D& a_T_b,
                              const WallChangeOptions& options) {
  WallChanges result;
  std::optional<ComparedCells> layout = layout_of(a, b, a_T_b);
  if (!layout) return result;
  result.cells = *std::move(layout);
  const Layer layer_a = layer_of(a, {0, 0, 0}, result.cells);
  const Layer layer_b = layer_of(b, a_T_b, result.cells);
  result.compared_m2 =
      cv::countNonZero(mask(layer_a.seen() & layer_b.seen())) * result.cells.cell_m * result.cells.cell_m;
  result.changes = Classification(layer_a, layer_b, options, result.cells).take_changes();
  std::stable_sort(result.changes.begin(), result.changes.end(),
                   [](const WallChange& x, const WallChange& y) {
                     return x.kind != y.kind ? x.kind < y.kind : x.length_m > y.length_m;
                   });
  return result;
}

}  // namespace psi_slam
