// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/grid_map.h"

#include <mrpt/math/TBoundingBox.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "rendering/frame_cells.h"
#include "rendering/grid_layout.h"
#include "rendering/standing_views.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TBoundingBox;
using mrpt::math::TPose2D;

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
        finder_(options, layout.resolution_m),
        evidence_(static_cast<std::size_t>(layout.width * layout.height)),
        counted_(evidence_.size()),
        cleared_(evidence_.size()) {}

  /// Adds the evidence of one frame. All lasers of the frame together count once per cell. Hits take
  /// precedence over passes.
  void add(const Frame& frame, const TPose2D& map_T_robot) {
    const FrameCells& found = finder_.find(frame, map_T_robot);
    for (const TouchedCell& cell : found.cells) {
      const auto index = static_cast<std::size_t>((found.y_min - layout_.y_min + cell.y) * layout_.width +
                                                  found.x_min - layout_.x_min + cell.x);
      if ((cell.marks & kCleared) != 0) cleared_[index] = true;
      if ((cell.marks & (kHit | kPassed)) == 0) continue;
      counted_[index] = true;
      evidence_[index] += (cell.marks & kHit) != 0 ? kHitEvidence : kPassEvidence;
    }
  }

  COccupancyGridMap2D::Ptr grid() const {
    auto grid = unknown_grid(layout_);
    for (std::int64_t y = 0; y < layout_.height; ++y) {
      auto* row = grid->getRow(static_cast<int>(y));
      for (std::int64_t x = 0; x < layout_.width; ++x) {
        const auto index = static_cast<std::size_t>(y * layout_.width + x);
        row[x] = cell_value(!counted_[index] && cleared_[index] ? kPassEvidence : evidence_[index]);
      }
    }
    return grid;
  }

 private:
  GridLayout layout_;
  FrameCellFinder finder_;
  std::vector<std::int32_t> evidence_;
  std::vector<bool> counted_;  // whether a frame has evidence of the cell, which may sum up to 0
  std::vector<bool> cleared_;  // whether a beam without return passed the cell
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
