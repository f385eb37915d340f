// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/grid_map.h"

#include <mrpt/math/TBoundingBox.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <stdexcept>
#include <string>

#include "rendering/standing_views.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TBoundingBox;
using mrpt::math::TPose2D;

constexpr int kHitEvidence = 3;
constexpr int kPassEvidence = -1;
constexpr int kMaxEvidence = 30'000;
/// Change of a cell's log-odds by one pass, in MRPT's units of 1/16 nat. After one pass, a cell is free with
/// probability 0.82; after one hit, it is occupied with probability 0.99.
constexpr int kLogOddsOfOnePass = 24;

using Point = mrpt::math::TPoint2D;

/// End point of a beam in the map's frame, in metres, and the evidence that the beam gives.
struct Ray {
  Point end;
  bool hit = false;       // an obstacle is at the end point
  bool returned = false;  // if false, the beam may have crossed glass or met a black surface
};

/// The rays of one scan. They all start at its laser.
struct Fan {
  Point start;
  std::vector<Ray> rays;
  BeamBearings bearings;          // beam bearings of the laser's last scan
  std::vector<Point> directions;  // unit vectors of the beams in the laser's frame
};

/// Turns scans into rays in the map's frame. Keeps the directions of each laser's beams from scan to scan.
class RayMaker {
 public:
  explicit RayMaker(const GridMapOptions& options) : options_(options) {}

  /// Returns the rays of all scans of a frame. The pointers are valid until the next call.
  const std::vector<const Fan*>& fans(const Frame& frame, const TPose2D& map_T_robot) {
    fans_.clear();
    for_each_scan(frame, map_T_robot, [&](const LaserScan& scan, const TPose2D& map_T_robot_then) {
      while (lasers_.size() <= scan.laser) lasers_.emplace_back();
      cast(scan, map_T_robot_then, lasers_[scan.laser]);
      fans_.push_back(&lasers_[scan.laser]);
    });
    return fans_;
  }

 private:
  void cast(const LaserScan& scan, const TPose2D& map_T_robot, Fan& fan) const {
    if (scan.bearings_rad != fan.bearings) {
      fan.bearings = scan.bearings_rad;
      fan.directions.clear();
      for (std::size_t i = 0; fan.bearings && i < fan.bearings->size(); ++i) {
        const double angle = static_cast<double>((*fan.bearings)[i]);
        fan.directions.emplace_back(std::cos(angle), std::sin(angle));
      }
    }
    const std::size_t beams = scan.ranges_m.size();
    if (fan.directions.size() != beams)
      throw std::invalid_argument("draw_grid_map: " + std::to_string(beams) + " ranges but " +
                                  std::to_string(fan.directions.size()) +
                                  " bearings, expected equal numbers");
    const TPose2D map_T_laser = map_T_robot + scan.robot_T_laser;
    if (!std::isfinite(map_T_laser.x) || !std::isfinite(map_T_laser.y) || !std::isfinite(map_T_laser.phi))
      throw std::invalid_argument("draw_grid_map: the pose of a laser is not finite");
    const double c = std::cos(map_T_laser.phi);
    const double s = std::sin(map_T_laser.phi);
    const double clear_m = std::min(options_.no_return_clears_m, static_cast<double>(scan.max_range_m));
    fan.start = {map_T_laser.x, map_T_laser.y};
    fan.rays.clear();
    for (std::size_t i = 0; i < beams; ++i) {
      const double range_m = static_cast<double>(scan.ranges_m[i]);
      if (std::isnan(range_m)) continue;
      const double length = std::min(std::isinf(range_m) ? clear_m : range_m, options_.max_range_m);
      const Point& direction = fan.directions[i];
      fan.rays.push_back({{fan.start.x + length * (c * direction.x - s * direction.y),
                           fan.start.y + length * (s * direction.x + c * direction.y)},
                          range_m <= options_.max_range_m,
                          std::isfinite(range_m)});
    }
  }

  GridMapOptions options_;
  std::deque<Fan> lasers_;  // index: laser; a deque keeps pointers to its elements valid
  std::vector<const Fan*> fans_;
};

TBoundingBox bounds_of(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot,
                       const GridMapOptions& options) {
  RayMaker maker(options);
  TBoundingBox bounds = TBoundingBox::PlusMinusInfinity();
  const auto include = [&](const Point& point) { bounds.updateWithPoint({point.x, point.y, 0}); };
  for (std::size_t i = 0; i < log.size(); ++i)
    for (const Fan* fan : maker.fans(log[i], map_T_robot[i])) {
      for (const Ray& ray : fan->rays) include(ray.end);
      include(fan->start);
    }
  if (log.empty()) include({0, 0});
  return bounds;
}

/// Extent of the grid. (x_min, y_min) is the offset of its lower left corner from the map's origin; all but
/// the resolution are in cells.
struct Layout {
  double resolution_m = 0;
  std::int64_t x_min = 0;
  std::int64_t y_min = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
};

Layout layout_for(const TBoundingBox& bounds, const GridMapOptions& options) {
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

/// Evidence of all scans for each cell. Hits add to it, passes subtract from it. Beams without return add no
/// evidence; they only clear cells that have no other evidence.
class Evidence {
 public:
  explicit Evidence(const Layout& layout)
      : layout_(layout),
        cells_(static_cast<std::size_t>(layout.width * layout.height)),
        cleared_(cells_.size()) {}

  /// Adds the evidence of one frame. All lasers of the frame together count once per cell. Hits take
  /// precedence over passes.
  void add_frame(const std::vector<const Fan*>& fans) {
    next_scan();
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays)
        if (ray.hit) count(index_of(ray.end), kHitEvidence);
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays)
        pass(in_cells(fan->start), in_cells(ray.end), [&](std::int64_t index) {
          if (ray.returned)
            count(index, kPassEvidence);
          else
            cleared_[static_cast<std::size_t>(index)] = true;
        });
  }

  COccupancyGridMap2D::Ptr grid() const {
    auto grid = COccupancyGridMap2D::Create();
    const double r = layout_.resolution_m;
    const auto edge = [r](std::int64_t cell) { return static_cast<float>(static_cast<double>(cell) * r); };
    grid->setSize(edge(layout_.x_min), edge(layout_.x_min + layout_.width), edge(layout_.y_min),
                  edge(layout_.y_min + layout_.height), static_cast<float>(r), 0.5F);
    if (grid->getSizeX() != layout_.width || grid->getSizeY() != layout_.height)
      throw std::logic_error("draw_grid_map: MRPT made a grid of another size than requested");
    for (std::int64_t y = 0; y < layout_.height; ++y) {
      auto* row = grid->getRow(static_cast<int>(y));
      for (std::int64_t x = 0; x < layout_.width; ++x) {
        const auto index = static_cast<std::size_t>(y * layout_.width + x);
        int evidence = cells_[index].evidence;
        if (cells_[index].last_scan == 0 && cleared_[index]) evidence = kPassEvidence;
        row[x] = static_cast<COccupancyGridMap2D::cellType>(
            std::clamp<int>(-evidence * kLogOddsOfOnePass, COccupancyGridMap2D::OCCGRID_CELLTYPE_MIN,
                            COccupancyGridMap2D::OCCGRID_CELLTYPE_MAX));
      }
    }
    return grid;
  }

 private:
  struct Cell {
    std::int16_t evidence = 0;
    std::uint16_t last_scan = 0;  ///< number of the last frame that counted in this cell; 0 if none did
  };

  void next_scan() {
    if (scan_ == std::numeric_limits<std::uint16_t>::max()) {
      for (Cell& cell : cells_) cell.last_scan = cell.last_scan == 0 ? 0 : 1;
      scan_ = 1;
    }
    ++scan_;
  }

  void count(std::int64_t index, int evidence) {
    Cell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.last_scan == scan_) return;
    cell.last_scan = scan_;
    cell.evidence =
        static_cast<std::int16_t>(std::clamp(cell.evidence + evidence, -kMaxEvidence, kMaxEvidence));
  }

  Point in_cells(const Point& point) const {
    return {point.x / layout_.resolution_m - static_cast<double>(layout_.x_min),
            point.y / layout_.resolution_m - static_cast<double>(layout_.y_min)};
  }

  std::int64_t index_of(const Point& point) const {
    const Point cell = in_cells(point);
    return static_cast<std::int64_t>(cell.y) * layout_.width + static_cast<std::int64_t>(cell.x);
  }

  /// Calls `visit` with the index of each cell of the digital line from `start` to `end`, except the cell of
  /// `end`. Both points are in cells.
  template <class Visit>
  void pass(const Point& start, const Point& end, Visit visit) {
    if (std::abs(end.x - start.x) >= std::abs(end.y - start.y))
      walk(start.x, start.y, end.x, end.y, 1, layout_.width, visit);
    else
      walk(start.y, start.x, end.y, end.x, layout_.width, 1, visit);
  }

  /// Steps along the longer axis of the line and computes the position across it at the middle of each step.
  /// Fixed-point arithmetic makes all machines choose the same cells.
  template <class Visit>
  static void walk(double along0, double across0, double along1, double across1, std::int64_t along_stride,
                   std::int64_t across_stride, Visit visit) {
    constexpr int kFractionBits = 32;
    constexpr double kOne = 4294967296.0;
    const auto first = static_cast<std::int64_t>(along0);
    const auto last = static_cast<std::int64_t>(along1);
    const std::int64_t step = last < first ? -1 : 1;
    const double slope = along1 == along0 ? 0 : (across1 - across0) / (along1 - along0);
    const std::int64_t across_step = std::llround(slope * static_cast<double>(step) * kOne);
    std::int64_t across =
        std::llround((across0 + (static_cast<double>(first) + 0.5 - along0) * slope) * kOne);
    std::int64_t index = first * along_stride;
    for (std::int64_t i = std::abs(last - first); i > 0; --i) {
      visit(index + (across >> kFractionBits) * across_stride);
      index += step * along_stride;
      across += across_step;
    }
  }

  Layout layout_;
  std::vector<Cell> cells_;
  std::vector<bool> cleared_;  // whether a beam without return passed the cell
  std::uint16_t scan_ = 0;
};

}  // namespace

COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot,
                                       const GridMapOptions& options) {
  if (log.size() != map_T_robot.size())
    throw std::invalid_argument("draw_grid_map: " + std::to_string(log.size()) + " scans but " +
                                std::to_string(map_T_robot.size()) + " poses");
  if (!(options.resolution_m > 0) || !(options.max_range_m > 0) || !(options.no_return_clears_m >= 0) ||
      !(options.margin_m >= 0))
    throw std::invalid_argument(
        "draw_grid_map: resolution_m and max_range_m must be positive, no_return_clears_m and margin_m must "
        "not be negative");
  Evidence evidence(layout_for(bounds_of(log, map_T_robot, options), options));
  RayMaker maker(options);
  std::size_t next = 0;
  const auto draw_until = [&](std::size_t end) {
    for (; next < end; ++next) evidence.add_frame(maker.fans(log[next], map_T_robot[next]));
  };
  for (const StandingSpan& span : standing_spans(log, map_T_robot)) {
    draw_until(span.begin);
    for (const StandingView& view : standing_views(log, span))
      evidence.add_frame(maker.fans(view.frame, map_T_robot[view.index]));
    next = span.end;
  }
  draw_until(log.size());
  return evidence.grid();
}

}  // namespace psi_slam
