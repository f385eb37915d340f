// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/grid_map.h"

#include <mrpt/math/TBoundingBox.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "map/rendering/cell_box.h"
#include "map/rendering/grid_layout.h"
#include "map/rendering/moving_things.h"
#include "map/rendering/scan_rays.h"
#include "map/rendering/standing_views.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TBoundingBox;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr int kMaxEvidence = 30'000;
constexpr int kMaxNewest = 5 * kHitEvidence;  // six scans outweigh all scans before

TBoundingBox bounds_of_log(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot,
                           const GridMapOptions& options) {
  RayMaker maker(options);
  TBoundingBox bounds = TBoundingBox::PlusMinusInfinity();
  for (std::size_t i = 0; i < log.size(); ++i) {
    const TBoundingBox of_frame = bounds_of(maker.fans(log[i], map_T_robot[i]));
    bounds.updateWithPoint(of_frame.min);
    bounds.updateWithPoint(of_frame.max);
  }
  if (log.empty()) bounds.updateWithPoint({0, 0, 0});
  return bounds;
}

/// A beam counts as this many beams if a neighbouring beam of its scan supports it.
constexpr unsigned kSupportedBeams = 2;
constexpr unsigned kMostBeams = 3;

/// Evidence of all scans for each cell. Hits add to it, passes subtract from it. Beams without return add no
/// evidence; they only clear cells that have no other evidence.
class Evidence {
 public:
  Evidence(const GridLayout& layout, const GridMapOptions& options)
      : layout_(layout),
        min_beams_(static_cast<unsigned>(options.min_beams)),
        maker_(options),
        cells_(static_cast<std::size_t>(layout.width * layout.height)),
        cleared_(cells_.size()) {}

  /// Adds the evidence of one frame. All lasers of the frame together count once per cell. Hits take
  /// precedence over passes, and beams that a neighbour supports over others.
  void add(const Frame& frame, const TPose2D& map_T_robot) {
    const std::vector<const Fan*>& fans = maker_.fans(frame, map_T_robot);
    const CellBox box = cell_box(bounds_of(fans), layout_.resolution_m);
    const std::int64_t corner = (box.y_min - layout_.y_min) * layout_.width + box.x_min - layout_.x_min;
    next_scan();
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays) {
        const TPoint2D end = box.in_cells(ray.end);
        const std::int64_t row = static_cast<std::int64_t>(end.y) * layout_.width;
        if (ray.hit)
          add_hit(cell_at(corner + row + static_cast<std::int64_t>(end.x)),
                  ray.alone_from < 1 ? 1 : kSupportedBeams);
      }
    passed_.clear();
    no_returns_.clear();
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays)
        pass(corner, box.in_cells(fan->start), box.in_cells(alone_point(*fan, ray)), ray.returned,
             kSupportedBeams);
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays)
        if (ray.alone_from < 1 && ray.returned)
          pass(corner, box.in_cells(alone_point(*fan, ray)), box.in_cells(ray.end), true, 1);
  }

  COccupancyGridMap2D::Ptr grid() const {
    auto grid = unknown_grid(layout_);
    for (std::int64_t y = 0; y < layout_.height; ++y) {
      auto* row = grid->getRow(static_cast<int>(y));
      for (std::int64_t x = 0; x < layout_.width; ++x) {
        const auto index = static_cast<std::size_t>(y * layout_.width + x);
        const bool is_cleared = cells_[index].last_scan() == 0 && cleared_[index];
        row[x] = cell_value(is_cleared ? kPassEvidence : enough_beams(x, y) ? cells_[index].evidence : 0);
      }
    }
    return grid;
  }

  /// Returns the cells whose newest scans show an obstacle that `grid`, the map of all scans, does not show.
  std::vector<NewObstacle> new_obstacles(const COccupancyGridMap2D& grid) const {
    std::vector<NewObstacle> found;
    for (std::int64_t y = 0; y < layout_.height; ++y) {
      const auto* row = grid.getRow(static_cast<int>(y));
      for (std::int64_t x = 0; x < layout_.width; ++x) {
        const Cell& cell = cells_[static_cast<std::size_t>(y * layout_.width + x)];
        if (cell.newest > 0 && cell.evidence <= 0)
          found.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), row[x]});
      }
    }
    return found;
  }

 private:
  struct Cell {
    std::int16_t evidence = 0;
    /// Bits 0 to 11: number of the last frame that counted in this cell, 0 if none did. Bits 12 and 13:
    /// number of beams that ended in the cell or crossed it, at most 3. Bits 14 and 15: of those that ended
    /// in it.
    std::uint16_t marks = 0;
    std::int16_t newest =
        0;  // evidence within kMaxNewest of free or occupied, so that new scans outweigh old

    unsigned last_scan() const { return marks & kLastScan; }
    unsigned beams() const { return marks >> kScanBits & kMostBeams; }
    unsigned hit_beams() const { return marks >> (kScanBits + kBeamBits) & kMostBeams; }
    void count(int of_scan) {
      evidence = static_cast<std::int16_t>(std::clamp(evidence + of_scan, -kMaxEvidence, kMaxEvidence));
      newest = static_cast<std::int16_t>(std::clamp(newest + of_scan, -kMaxNewest, kMaxNewest));
    }
    void mark(unsigned scan, unsigned beams, unsigned hit_beams) {
      marks = static_cast<std::uint16_t>(scan | beams << kScanBits | hit_beams << (kScanBits + kBeamBits));
    }
  };
  static constexpr unsigned kScanBits = 12;
  static constexpr unsigned kBeamBits = 2;
  static constexpr unsigned kLastScan = (1U << kScanBits) - 1;
  static_assert(kMostBeams == (1U << kBeamBits) - 1);

  void next_scan() {
    if (scan_ == kLastScan) {
      for (Cell& cell : cells_) cell.mark(cell.last_scan() == 0 ? 0 : 1, cell.beams(), cell.hit_beams());
      scan_ = 1;
    }
    ++scan_;
  }

  /// Point on a ray from which on it has no support.
  static TPoint2D alone_point(const Fan& fan, const Ray& ray) {
    return ray.alone_from < 1 ? fan.start + (ray.end - fan.start) * ray.alone_from : ray.end;
  }

  /// Counts a beam in all cells from `start` to `end`, except the cell of `end`.
  void pass(std::int64_t corner, const TPoint2D& start, const TPoint2D& end, bool returned, unsigned beams) {
    const DigitalLine line = digital_line(start, end, layout_.width);
    // Local copies, because a write of a cell could change any member as far as the compiler knows.
    if (returned)
      passed_.walk(line, [cells = &cells_[static_cast<std::size_t>(corner)], scan = scan_,
                          beams](std::int64_t index) { add_pass(cells[index], scan, beams); });
    else
      no_returns_.walk(
          line, [&](std::int64_t index) { cleared_[static_cast<std::size_t>(corner + index)] = true; });
  }

  Cell& cell_at(std::int64_t index) { return cells_[static_cast<std::size_t>(index)]; }

  void add_hit(Cell& cell, unsigned beams) const {
    if (cell.last_scan() == scan_) return;
    cell.mark(scan_, std::min(kMostBeams, cell.beams() + beams),
              std::min(kMostBeams, cell.hit_beams() + beams));
    cell.count(kHitEvidence);
  }

  static void add_pass(Cell& cell, unsigned scan, unsigned beams) {
    if (cell.last_scan() == scan) return;
    cell.mark(scan, std::min(kMostBeams, cell.beams() + beams), cell.hit_beams());
    cell.count(kPassEvidence);
  }

  /// Whether enough beams saw what a cell shows. An obstacle counts the beams that ended in the eight cells
  /// around it, too. The map has a margin of two cells, so they are within it.
  bool enough_beams(std::int64_t x, std::int64_t y) const {
    const std::int64_t index = y * layout_.width + x;
    const Cell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.evidence <= 0) return cell.beams() >= min_beams_;
    unsigned beams = 0;
    for (const std::int64_t row : {index - layout_.width, index, index + layout_.width})
      for (const std::int64_t around : {row - 1, row, row + 1})
        beams += cells_[static_cast<std::size_t>(around)].hit_beams();
    return beams >= min_beams_;
  }

  GridLayout layout_;
  unsigned min_beams_;
  RayMaker maker_;
  std::vector<Cell> cells_;
  std::vector<bool> cleared_;  // whether a beam without return passed the cell
  unsigned scan_ = 0;
  LineFan passed_;      // of this frame: lines of the beams with a return
  LineFan no_returns_;  // and of the others
};

/// Calls `draw(frame, map_T_robot)` for each frame to draw, with at most 64 for a long standstill.
template <class Draw>
void for_each_drawn_frame(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot,
                          const Draw& draw) {
  std::size_t next = 0;
  const auto draw_until = [&](std::size_t end) {
    for (; next < end; ++next) draw(log[next], map_T_robot[next]);
  };
  for (const StandingSpan& span : standing_spans(log, map_T_robot)) {
    draw_until(span.begin);
    for (const StandingView& view : standing_views(log, span)) draw(view.frame, map_T_robot[view.index]);
    next = span.end;
  }
  draw_until(log.size());
}

}  // namespace

COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot,
                                       const GridMapOptions& options) {
  if (log.size() != map_T_robot.size())
    throw std::invalid_argument("draw_grid_map: " + std::to_string(log.size()) + " scans but " +
                                std::to_string(map_T_robot.size()) + " poses");
  check_drawable(options);
  const GridLayout layout = layout_for(bounds_of_log(log, map_T_robot, options), options);
  Evidence evidence(layout, options);
  for_each_drawn_frame(log, map_T_robot,
                       [&](const Frame& frame, const TPose2D& pose) { evidence.add(frame, pose); });
  const auto grid = evidence.grid();
  if (options.keep_moving) return grid;
  MovingThings moving(*grid, evidence.new_obstacles(*grid), layout, options);
  for_each_drawn_frame(log, map_T_robot,
                       [&](const Frame& frame, const TPose2D& pose) { moving.add(frame, pose); });
  moving.update(*grid);
  return grid;
}

}  // namespace psi_slam
