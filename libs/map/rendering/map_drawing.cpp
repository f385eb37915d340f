// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_drawing.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using CellLine = std::vector<cv::Point>;

/// Returns a mask of the observed cells: 255 where a cell is occupied, else 0. Row 0 is the lowest row of the
/// map.
cv::Mat occupied_mask(const COccupancyGridMap2D& grid, const SeenCells& seen) {
  cv::Mat mask(seen.y_end - seen.y_begin, seen.x_end - seen.x_begin, CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    const auto* cells = grid.getRow(seen.y_begin + y);
    auto* row = mask.ptr<std::uint8_t>(y);
    for (int x = 0; x < mask.cols; ++x) row[x] = is_occupied(cells[seen.x_begin + x]) ? 255 : 0;
  }
  return mask;
}

std::vector<MapLine> wall_lines(const COccupancyGridMap2D& grid, const SeenCells& seen,
                                const MapDrawingOptions& options) {
  std::vector<CellLine> contours;
  cv::findContours(occupied_mask(grid, seen), contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  const auto cell_m = static_cast<double>(grid.getResolution());
  const double x_min_m = static_cast<double>(grid.getXMin()) + (seen.x_begin + 0.5) * cell_m;
  const double y_min_m = static_cast<double>(grid.getYMin()) + (seen.y_begin + 0.5) * cell_m;
  std::vector<MapLine> lines;
  for (const CellLine& contour : contours) {
    const cv::Rect box = cv::boundingRect(contour);
    if (std::max(box.width, box.height) * cell_m < options.min_wall_m) continue;
    CellLine simplified;
    cv::approxPolyDP(contour, simplified, options.tolerance_m / cell_m, true);
    if (simplified.size() < 2) continue;
    MapLine line;
    for (const cv::Point& cell : simplified)
      line.emplace_back(x_min_m + cell.x * cell_m, y_min_m + cell.y * cell_m);
    lines.push_back(std::move(line));
  }
  return lines;
}

MapLine path_line(const std::vector<mrpt::math::TPose2D>& map_T_robot, double tolerance_m) {
  std::vector<cv::Point2f> path;
  path.reserve(map_T_robot.size());
  for (const auto& pose : map_T_robot)
    path.emplace_back(static_cast<float>(pose.x), static_cast<float>(pose.y));
  std::vector<cv::Point2f> simplified;
  if (!path.empty()) cv::approxPolyDP(path, simplified, tolerance_m, false);
  MapLine line;
  for (const cv::Point2f& point : simplified)
    line.emplace_back(static_cast<double>(point.x), static_cast<double>(point.y));
  return line;
}

}  // namespace

MapRectangle seen_extent(const COccupancyGridMap2D& grid, const SeenCells& seen) {
  const auto cell_m = static_cast<double>(grid.getResolution());
  const auto x_min_m = static_cast<double>(grid.getXMin());
  const auto y_min_m = static_cast<double>(grid.getYMin());
  return {x_min_m + seen.x_begin * cell_m, x_min_m + seen.x_end * cell_m, y_min_m + seen.y_begin * cell_m,
          y_min_m + seen.y_end * cell_m};
}

MapDrawing draw_map_lines(const COccupancyGridMap2D& grid,
                          const std::vector<std::vector<mrpt::math::TPose2D>>& paths,
                          const MapDrawingOptions& options) {
  const SeenCells seen = seen_cells(grid);
  MapDrawing drawing;
  drawing.walls = wall_lines(grid, seen, options);
  drawing.extent = seen_extent(grid, seen);
  for (const auto& path : paths) {
    drawing.trajectories.push_back(path_line(path, options.tolerance_m));
    for (const TPoint2D& point : drawing.trajectories.back()) {
      drawing.extent.x_min_m = std::min(drawing.extent.x_min_m, point.x);
      drawing.extent.x_max_m = std::max(drawing.extent.x_max_m, point.x);
      drawing.extent.y_min_m = std::min(drawing.extent.y_min_m, point.y);
      drawing.extent.y_max_m = std::max(drawing.extent.y_max_m, point.y);
    }
  }
  drawing.cell_m = static_cast<double>(grid.getResolution());
  return drawing;
}

}  // namespace psi_slam
