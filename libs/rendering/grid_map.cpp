// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/grid_map.h"

#include <mrpt/math/TBoundingBox.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "rendering/digital_line.h"
#include "rendering/grid_layout.h"
#include "rendering/scan_rays.h"
#include "rendering/standing_views.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TBoundingBox;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr int kMaxEvidence = 30'000;

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

/// Evidence of all scans for each cell. Hits add to it, passes subtract from it. Beams without return add no
/// evidence; they only clear cells that have no other evidence.
class Evidence {
 public:
  Evidence(const GridLayout& layout, const GridMapOptions& options)
      : layout_(layout),
        maker_(options),
        cells_(static_cast<std::size_t>(layout.width * layout.height)),
        cleared_(cells_.size()) {}

  /// Adds the evidence of one frame. All lasers of the frame together count once per cell. Hits take
  /// precedence over passes.
  void add(const Frame& frame, const TPose2D& map_T_robot) {
    const std::vector<const Fan*>& fans = maker_.fans(frame, map_T_robot);
    const CellBox box = cell_box(bounds_of(fans), layout_.resolution_m);
    const std::int64_t corner = (box.y_min - layout_.y_min) * layout_.width + box.x_min - layout_.x_min;
    next_scan();
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays) {
        const TPoint2D end = box.in_cells(ray.end);
        const std::int64_t row = static_cast<std::int64_t>(end.y) * layout_.width;
        if (ray.hit) count(corner + row + static_cast<std::int64_t>(end.x), kHitEvidence);
      }
    for (const Fan* fan : fans)
      for (const Ray& ray : fan->rays)
        walk_line(box.in_cells(fan->start), box.in_cells(ray.end), layout_.width, [&](std::int64_t index) {
          if (ray.returned)
            count(corner + index, kPassEvidence);
          else
            cleared_[static_cast<std::size_t>(corner + index)] = true;
        });
  }

  COccupancyGridMap2D::Ptr grid() const {
    auto grid = unknown_grid(layout_);
    for (std::int64_t y = 0; y < layout_.height; ++y) {
      auto* row = grid->getRow(static_cast<int>(y));
      for (std::int64_t x = 0; x < layout_.width; ++x) {
        const auto index = static_cast<std::size_t>(y * layout_.width + x);
        int evidence = cells_[index].evidence;
        if (cells_[index].last_scan == 0 && cleared_[index]) evidence = kPassEvidence;
        row[x] = cell_value(evidence);
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

  GridLayout layout_;
  RayMaker maker_;
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
  check_drawable(options);
  Evidence evidence(layout_for(bounds_of_log(log, map_T_robot, options), options), options);
  std::size_t next = 0;
  const auto draw_until = [&](std::size_t end) {
    for (; next < end; ++next) evidence.add(log[next], map_T_robot[next]);
  };
  for (const StandingSpan& span : standing_spans(log, map_T_robot)) {
    draw_until(span.begin);
    for (const StandingView& view : standing_views(log, span))
      evidence.add(view.frame, map_T_robot[view.index]);
    next = span.end;
  }
  draw_until(log.size());
  return evidence.grid();
}

}  // namespace psi_slam
