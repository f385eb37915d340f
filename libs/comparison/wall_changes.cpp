// SPDX-License-Identifier: BSD-3-Clause
#include "comparison/wall_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/portable_math.h"
#include "frames/pose_operations.h"
#include "matching/score_grid.h"
#include "rendering/map_image.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using Kind = WallChange::Kind;
using Cells = std::vector<cv::Point>;

constexpr int kBridgedCells = 2;        // changed cells this far apart belong to one change
constexpr double kLeastFilled = 0.5;    // share of the length of a change that has cells; others are dotted
constexpr double kLeastParallel = 0.6;  // share of a moved wall's cells that have moved by the same distance

/// The value of an expression of masks, such as `a & b`.
cv::Mat1b mask(const cv::Mat& expression) {
  return expression;
}

cv::Mat1b empty_mask(int rows, int columns) {
  return cv::Mat1b(rows, columns, std::uint8_t{0});
}

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

/// The cells of a mask that are nearest to each cell, with their distances in cells.
class NearestCells {
 public:
  explicit NearestCells(const cv::Mat1b& cells) {
    cv::distanceTransform(~cells, distance_, labels_, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
    for (int y = 0; y < cells.rows; ++y) {
      for (int x = 0; x < cells.cols; ++x) {
        if (cells(y, x) == 0) continue;
        const auto label = static_cast<std::size_t>(labels_(y, x));
        if (cells_.size() <= label) cells_.resize(label + 1);
        cells_[label] = {x, y};
      }
    }
  }

  bool empty() const { return cells_.empty(); }
  double distance(const cv::Point& cell) const { return static_cast<double>(distance_(cell)); }
  cv::Point nearest(const cv::Point& cell) const { return cells_[static_cast<std::size_t>(labels_(cell))]; }

 private:
  cv::Mat1f distance_;
  cv::Mat1i labels_;
  Cells cells_;
};

/// Returns the cells of `walls` without a wall of `others` within the tolerance.
cv::Mat1b without_counterpart(const cv::Mat1b& walls, const cv::Mat1b& others, double tolerance_cells) {
  cv::Mat1f distance;
  cv::distanceTransform(~others, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return mask(walls & (distance > tolerance_cells));
}

/// A connected set of changed cells and its extent.
struct Change {
  Cells cells;
  double filled_cells = 0;  ///< length of the parts that have cells, along the main direction
  cv::Point2d from;         ///< ends along the main direction, in cells
  cv::Point2d to;

  double length_cells() const { return portable::hypot(to.x - from.x, to.y - from.y) + 1; }
};

Change change_of(Cells cells) {
  cv::Point2d mean(0, 0);
  for (const cv::Point& cell : cells) mean += cv::Point2d(cell);
  mean /= static_cast<double>(cells.size());
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (const cv::Point& cell : cells) {
    const cv::Point2d offset = cv::Point2d(cell) - mean;
    xx += offset.x * offset.x;
    xy += offset.x * offset.y;
    yy += offset.y * offset.y;
  }
  const double direction_rad = 0.5 * portable::atan2(2 * xy, xx - yy);
  const cv::Point2d direction(portable::cos(direction_rad), portable::sin(direction_rad));
  double least = 0;
  double most = 0;
  std::set<int> filled;
  for (const cv::Point& cell : cells) {
    const double along = direction.dot(cv::Point2d(cell) - mean);
    least = std::min(least, along);
    most = std::max(most, along);
    filled.insert(static_cast<int>(std::floor(along)));
  }
  return {std::move(cells), static_cast<double>(filled.size()), mean + least * direction,
          mean + most * direction};
}

/// Returns the connected changes of a mask that are long and dense enough.
std::vector<Change> changes_in(const cv::Mat1b& changed, double min_length_cells) {
  cv::Mat1b bridged;
  const int side = 1 + kBridgedCells;
  cv::dilate(changed, bridged, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  cv::Mat1i labels;
  const int count = cv::connectedComponents(bridged, labels, 8, CV_32S);
  std::vector<Cells> parts(static_cast<std::size_t>(count));
  for (int y = 0; y < changed.rows; ++y)
    for (int x = 0; x < changed.cols; ++x)
      if (changed(y, x) != 0) parts[static_cast<std::size_t>(labels(y, x))].emplace_back(x, y);
  std::vector<Change> changes;
  for (Cells& part : parts) {
    if (part.empty()) continue;
    Change change = change_of(std::move(part));
    const double length = change.length_cells();
    if (length >= min_length_cells && change.filled_cells >= kLeastFilled * length)
      changes.push_back(std::move(change));
  }
  return changes;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the shift, in cells, from a change to parallel walls beside it. Empty without such walls.
std::optional<cv::Point2d> shift_to(const NearestCells& walls, const Change& change, double farthest_cells,
                                    double tolerance_cells) {
  if (walls.empty()) return std::nullopt;
  std::vector<double> distances;
  std::vector<double> dx;
  std::vector<double> dy;
  for (const cv::Point& cell : change.cells) {
    const double distance = walls.distance(cell);
    if (distance > farthest_cells) continue;
    const cv::Point step = walls.nearest(cell) - cell;
    distances.push_back(distance);
    dx.push_back(step.x);
    dy.push_back(step.y);
  }
  if (distances.empty()) return std::nullopt;
  const double usual = median(distances);
  const auto parallel = std::count_if(distances.begin(), distances.end(), [&](double distance) {
    return std::abs(distance - usual) <= tolerance_cells;
  });
  if (static_cast<double>(parallel) < kLeastParallel * static_cast<double>(change.cells.size()))
    return std::nullopt;
  return cv::Point2d(median(std::move(dx)), median(std::move(dy)));
}

cv::Mat1b mask_of(const std::vector<Change>& changes, const cv::Size& size) {
  cv::Mat1b cells = empty_mask(size.height, size.width);
  for (const Change& change : changes)
    for (const cv::Point& cell : change.cells) cells(cell) = 255;
  return cells;
}

/// Paints the cells of a change, moved by `shift` cells, into `cells`.
void paint_shifted(const Change& change, const cv::Point2d& shift, cv::Mat1b& cells) {
  const cv::Rect area(0, 0, cells.cols, cells.rows);
  for (const cv::Point& cell : change.cells) {
    const cv::Point place = cell + cv::Point(cvRound(shift.x), cvRound(shift.y));
    if (area.contains(place)) cells(place) = 255;
  }
}

WallChange in_metres(const Change& change, Kind kind, const cv::Point2d& shift_cells,
                     const ComparedCells& layout) {
  WallChange result;
  result.kind = kind;
  result.from = centre_of(layout, change.from.x, change.from.y);
  result.to = centre_of(layout, change.to.x, change.to.y);
  result.length_m = change.length_cells() * layout.cell_m;
  result.shift = TPoint2D(shift_cells.x, shift_cells.y) * layout.cell_m;
  return result;
}

/// Classifies the changes of two layers and paints them into `cells`.
class Classification {
 public:
  Classification(const Layer& a, const Layer& b, const WallChangeOptions& options, ComparedCells& cells)
      : cells_(cells),
        tolerance_(options.tolerance_m / cells.cell_m),
        farthest_(options.farthest_move_m / cells.cell_m),
        min_length_(options.min_length_m / cells.cell_m),
        only_a_(without_counterpart(a.wall, b.wall, tolerance_)),
        only_b_(without_counterpart(b.wall, a.wall, tolerance_)),
        gone_(changes_in(mask(only_a_ & b.free), min_length_)),
        new_(changes_in(mask(only_b_ & a.free), min_length_)) {
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
    const cv::Mat1b seen_a = a.seen();
    const cv::Mat1b seen_b = b.seen();
    cells_.cells.assign(static_cast<std::size_t>(cells_.width) * static_cast<std::size_t>(cells_.height),
                        ComparedCell::kUnknown);
    for (int y = 0; y < cells_.height; ++y) {
      for (int x = 0; x < cells_.width; ++x) {
        const bool unseen_by_one = seen_a(y, x) == 0 || seen_b(y, x) == 0;
        if (unseen_by_one && (only_a_(y, x) != 0 || only_b_(y, x) != 0))
          paint({x, y}, ComparedCell::kWallOfOne);
        else if (a.wall(y, x) != 0 || b.wall(y, x) != 0)
          paint({x, y}, ComparedCell::kWall);
        else if (a.free(y, x) != 0 || b.free(y, x) != 0)
          paint({x, y}, ComparedCell::kFree);
      }
    }
  }

  void add(const Change& change, Kind kind, const cv::Point2d& shift = {0, 0}) {
    found_.push_back(in_metres(change, kind, shift, cells_));
  }

  void classify() {
    const NearestCells walls_of_b(only_b_);
    cv::Mat1b moved = empty_mask(cells_.height, cells_.width);  // moved walls at their new places
    for (const Change& change : gone_) {
      const auto shift = shift_to(walls_of_b, change, farthest_, tolerance_);
      if (shift) paint_shifted(change, *shift, moved);
      add(change, shift ? Kind::kMoved : Kind::kVanished, shift.value_or(cv::Point2d(0, 0)));
      for (const cv::Point& cell : change.cells) paint(cell, ComparedCell::kVanished);
    }
    const NearestCells hidden_walls(mask(only_a_ & ~mask_of(gone_, only_a_.size())));
    for (const Change& change : new_)
      for (const cv::Point& cell : change.cells) paint(cell, ComparedCell::kAppeared);
    const cv::Mat1b unclaimed = without_counterpart(mask_of(new_, only_b_.size()), moved, tolerance_);
    for (const Change& change : changes_in(unclaimed, min_length_)) {
      // The old place of the wall may lie behind its new place, where map B shows nothing.
      if (const auto back = shift_to(hidden_walls, change, farthest_, tolerance_)) {
        Change before = change;
        before.from += *back;
        before.to += *back;
        add(before, Kind::kMoved, -*back);
      } else {
        add(change, Kind::kAppeared);
      }
    }
  }

  ComparedCells& cells_;
  double tolerance_;
  double farthest_;
  double min_length_;
  cv::Mat1b only_a_;  ///< walls of A that are no walls of B
  cv::Mat1b only_b_;
  std::vector<Change> gone_;  ///< walls of A where B shows free space
  std::vector<Change> new_;   ///< walls of B where A shows free space
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
