// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_edits.h"

#include <mrpt/math/TPolygon2D.h>
#include <mrpt/math/TSegment2D.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using Kind = MapEdit::Kind;

constexpr float kFree = 0.99F;  // probabilities of free space
constexpr float kWall = 0.01F;
constexpr float kUnknown = 0.5F;

/// Cells [x_begin, x_end) x [y_begin, y_end).
struct CellRectangle {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
};

/// Lower left and upper right corner of the rectangle around the points.
std::pair<TPoint2D, TPoint2D> corners_around(const std::vector<TPoint2D>& points) {
  TPoint2D low = points.front();
  TPoint2D high = points.front();
  for (const TPoint2D& point : points) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
  return {low, high};
}

/// Cells of the grid that touch the rectangle around the points, widened by `margin_m`.
CellRectangle cells_around(const std::vector<TPoint2D>& points, double margin_m, const Grid& grid) {
  const auto resolution_m = static_cast<double>(grid.getResolution());
  const auto cell = [&](double metres, float origin_m, unsigned cells) {
    const double index = std::floor((metres - static_cast<double>(origin_m)) / resolution_m);
    return static_cast<int>(std::clamp(index, -1.0, static_cast<double>(cells)));
  };
  const auto [low, high] = corners_around(points);
  const auto width = static_cast<unsigned>(grid.getSizeX());
  const auto height = static_cast<unsigned>(grid.getSizeY());
  return {std::max(0, cell(low.x - margin_m, grid.getXMin(), width)),
          std::min(static_cast<int>(width), cell(high.x + margin_m, grid.getXMin(), width) + 1),
          std::max(0, cell(low.y - margin_m, grid.getYMin(), height)),
          std::min(static_cast<int>(height), cell(high.y + margin_m, grid.getYMin(), height) + 1)};
}

/// Cells of the grid whose centre lies in the rectangle around the points.
CellRectangle centres_around(const std::vector<TPoint2D>& points, const Grid& grid) {
  const auto [low, high] = corners_around(points);
  CellRectangle cells = cells_around(points, 0, grid);
  if (static_cast<double>(grid.idx2x(cells.x_begin)) < low.x) ++cells.x_begin;
  if (static_cast<double>(grid.idx2x(cells.x_end - 1)) > high.x) --cells.x_end;
  if (static_cast<double>(grid.idx2y(cells.y_begin)) < low.y) ++cells.y_begin;
  if (static_cast<double>(grid.idx2y(cells.y_end - 1)) > high.y) --cells.y_end;
  return cells;
}

/// Returns whether a point lies within `distance_m` of a line.
bool is_near_line(const TPoint2D& point, const std::vector<TPoint2D>& line, double distance_m) {
  for (std::size_t i = 1; i < line.size(); ++i)
    if (mrpt::math::TSegment2D(line[i - 1], line[i]).distance(point) <= distance_m) return true;
  return false;
}

/// Returns a grid of the cells in the rectangle only.
Grid cropped(const Grid& grid, const CellRectangle& kept) {
  const float resolution_m = grid.getResolution();
  const auto limit = [&](float origin_m, int cells) {
    return static_cast<float>(static_cast<double>(origin_m) + cells * static_cast<double>(resolution_m));
  };
  Grid result;
  result.setSize(limit(grid.getXMin(), kept.x_begin), limit(grid.getXMin(), kept.x_end),
                 limit(grid.getYMin(), kept.y_begin), limit(grid.getYMin(), kept.y_end), resolution_m,
                 kUnknown);
  const int width = std::min(kept.x_end - kept.x_begin, static_cast<int>(result.getSizeX()));
  const int height = std::min(kept.y_end - kept.y_begin, static_cast<int>(result.getSizeY()));
  for (int y = 0; y < height; ++y)
    std::copy_n(grid.getRow(kept.y_begin + y) + kept.x_begin, width, result.getRow(y));
  return result;
}

/// Makes all cells outside the polygon unknown and shrinks the grid to the cells whose centre lies in the
/// rectangle around the polygon. Requires at least one cell in the polygon.
void crop(const MapEdit& edit, Grid& grid) {
  Grid kept = grid;
  kept.fill(kUnknown);
  for_each_cell_of(edit, grid, [&](int x, int y) { kept.getRow(y)[x] = grid.getRow(y)[x]; });
  grid = cropped(kept, centres_around(edit.points, grid));
}

std::string name_of(const MapEdit& edit) {
  switch (edit.kind) {
    case Kind::kErase:
      return "erase";
    case Kind::kUnknown:
      return "unknown";
    case Kind::kWall:
      return "wall";
    case Kind::kCrop:
      return "crop";
    case Kind::kKeepOut:
      return "keep_out";
    case Kind::kSlow:
      return "slow";
  }
  return "";
}

std::string complaint(const MapEdit& edit) {
  return name_of(edit) + " at " + trimmed_text(edit.points.front().x, 3) + ',' +
         trimmed_text(edit.points.front().y, 3) +
         ": no cell of the map lies there. Coordinates are metres in the frame of the exported map";
}

}  // namespace

std::string text_of(const MapEdit& edit) {
  switch (edit.kind) {
    case Kind::kErase:
      return "erase polygon";
    case Kind::kUnknown:
      return "mark polygon as unknown";
    case Kind::kWall:
      return "draw wall";
    case Kind::kCrop:
      return "crop map";
    case Kind::kKeepOut:
      return "add keep-out zone";
    case Kind::kSlow:
      return "add slow zone of " + (edit.percent > 0 ? trimmed_text(edit.percent, 2) + " %"
                                                     : trimmed_text(edit.max_speed_mps, 3) + " m/s");
  }
  return "";
}

std::size_t for_each_cell_of(const MapEdit& edit, const Grid& grid,
                             const std::function<void(int x, int y)>& visit) {
  const bool is_line = edit.kind == Kind::kWall;
  const double reach_m =
      is_line ? 0.5 * std::max(edit.width_m, M_SQRT2 * static_cast<double>(grid.getResolution())) : 0;
  const CellRectangle around = cells_around(edit.points, reach_m, grid);
  mrpt::math::TPolygon2D polygon;
  polygon.assign(edit.points.begin(), edit.points.end());
  std::size_t count = 0;
  for (int y = around.y_begin; y < around.y_end; ++y) {
    for (int x = around.x_begin; x < around.x_end; ++x) {
      const TPoint2D centre(static_cast<double>(grid.idx2x(x)), static_cast<double>(grid.idx2y(y)));
      if (!(is_line ? is_near_line(centre, edit.points, reach_m) : polygon.contains(centre))) continue;
      ++count;
      visit(x, y);
    }
  }
  return count;
}

std::vector<std::string> apply_map_edits(const std::vector<MapEdit>& edits, Grid& grid) {
  std::vector<std::string> complaints;
  for (const MapEdit& edit : edits) {
    if (edit.is_zone()) continue;
    const auto fill = [&](float value) {
      return for_each_cell_of(edit, grid, [&](int x, int y) { grid.setCell(x, y, value); });
    };
    std::size_t cells = 0;
    if (edit.kind == Kind::kErase)
      cells = fill(kFree);
    else if (edit.kind == Kind::kUnknown)
      cells = fill(kUnknown);
    else if (edit.kind == Kind::kWall)
      cells = fill(kWall);
    else
      cells = for_each_cell_of(edit, grid, [](int, int) {});
    if (cells == 0)
      complaints.push_back(complaint(edit));
    else if (edit.kind == Kind::kCrop)
      crop(edit, grid);
  }
  for (const MapEdit& edit : edits)  // a later crop may cut off a zone
    if (edit.is_zone() && for_each_cell_of(edit, grid, [](int, int) {}) == 0)
      complaints.push_back(complaint(edit));
  return complaints;
}

}  // namespace psi_slam
