// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/live_grid_map.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "logs/frames/discarded_ranges.h"

namespace psi_slam {
namespace {

using mrpt::math::TBoundingBox;
using mrpt::math::TPose2D;

/// Number of last frames whose scans the mapper may still change. It straightens the last scan and discards
/// ranges of scans up to 41 frames ago at a standstill. It also discards those of superseded scans long ago.
constexpr std::size_t kRecentFrames = 64;

/// Number of successive frames whose common bounds are computed again when one of them has moved.
constexpr std::size_t kFramesWithBounds = 64;

bool is_same_scan(const LaserScan& a, const LaserScan& b) {
  if (a.ranges_m.size() != b.ranges_m.size()) return false;
  if (a.ranges_m.empty()) return true;
  return (a.bearings_rad == b.bearings_rad || *a.bearings_rad == *b.bearings_rad) &&
         std::memcmp(a.ranges_m.data(), b.ranges_m.data(), a.ranges_m.size() * sizeof(float)) == 0;
}

/// Whether the mapper has not changed a frame since it was copied.
bool is_same_frame(const Frame& a, const Frame& b) {
  const auto is_same_companion = [](const CompanionScan& one, const CompanionScan& other) {
    return is_same_scan(one.scan, other.scan) && one.frame_T_robot == other.frame_T_robot;
  };
  return is_same_scan(a.scan, b.scan) &&
         std::equal(a.companions.begin(), a.companions.end(), b.companions.begin(), b.companions.end(),
                    is_same_companion);
}

void include(const TBoundingBox& box, TBoundingBox& bounds) {
  bounds.updateWithPoint(box.min);
  bounds.updateWithPoint(box.max);
}

/// Whether a box within `bounds` touches their edge.
bool touches_edge(const TBoundingBox& box, const TBoundingBox& bounds) {
  return box.min.x <= bounds.min.x || box.min.y <= bounds.min.y || box.max.x >= bounds.max.x ||
         box.max.y >= bounds.max.y;
}

}  // namespace

LiveGridMap::LiveGridMap(const LiveGridOptions& options)
    : options_(options),
      finder_(options.map, options.map.resolution_m),
      resolution_m_(options.map.resolution_m) {
  check_drawable(options.map);
}

void LiveGridMap::update(const std::vector<Frame>& log, const Poses& map_T_robot, const Hurry& hurry) {
  follow_changes(log);
  for (std::size_t i = drawn_.size(); i < log.size(); ++i) {
    drawn_.emplace_back();
    ++missing_;
    draw(log[i], map_T_robot(i), i);
    if (i + kRecentFrames >= log.size()) recent_.push_back(log[i]);
  }
  while (recent_.size() > kRecentFrames) recent_.pop_front();
  draw_moved(log, map_T_robot, hurry);
  use_coarser_cells_if_needed();
}

/// Draws the recent frames again that the mapper has changed.
void LiveGridMap::follow_changes(const std::vector<Frame>& log) {
  for (std::size_t k = 0; k < recent_.size(); ++k) {
    const std::size_t i = drawn_.size() - recent_.size() + k;
    if (is_same_frame(recent_[k], log[i])) continue;
    Drawn& drawn = drawn_[i];
    take_out(recent_[k], drawn);
    draw(log[i], drawn.map_T_robot, i);
    recent_[k] = log[i];
  }
}

void LiveGridMap::draw_moved(const std::vector<Frame>& log, const Poses& map_T_robot, const Hurry& hurry) {
  std::size_t redrawn = 0;
  const std::size_t checks = std::min(options_.checked_scans, drawn_.size());
  for (std::size_t check = 0; check < checks; ++check) {
    if (next_check_ >= drawn_.size()) next_check_ = 0;
    Drawn& drawn = drawn_[next_check_];
    const TPose2D pose = map_T_robot(next_check_);
    const bool has_ranges_now = has_ranges(as_drawn(next_check_, log));
    if (drawn.is_drawn && drawn.has_ranges && !has_ranges_now) {
      // The scan is superseded. It cannot be taken out of the map without its ranges.
      drawn.has_ranges = false;
      --with_ranges_;
      if (++superseded_ > with_ranges_) return start_again(resolution_m_);
    }
    const bool is_wrong = !drawn.is_drawn || !is_same_place(pose, drawn.map_T_robot, options_.moved);
    if (is_wrong && (!drawn.is_drawn || has_ranges_now)) {
      if (redrawn == options_.redrawn_scans || (redrawn > 0 && hurry && hurry())) return;
      ++redrawn;
      const Frame& frame = as_drawn(next_check_, log);
      take_out(frame, drawn);
      draw(frame, pose, next_check_);
      unmoved_ = 0;
    } else {
      unmoved_ = std::min(unmoved_ + 1, drawn_.size());
    }
    ++next_check_;
  }
}

const Frame& LiveGridMap::as_drawn(std::size_t frame, const std::vector<Frame>& log) const {
  const std::size_t first_recent = drawn_.size() - recent_.size();
  return frame < first_recent ? log[frame] : recent_[frame - first_recent];
}

void LiveGridMap::draw(const Frame& frame, const TPose2D& map_T_robot, std::size_t index) {
  const FrameCells& found = finder_.find(frame, map_T_robot);
  tiles_.add(found);
  Drawn& drawn = drawn_[index];
  if (index / kFramesWithBounds >= bounds_.size()) bounds_.emplace_back();
  Bounds& bounds = bounds_[index / kFramesWithBounds];
  bounds.may_shrink = bounds.may_shrink || touches_edge(drawn.bounds, bounds.box);
  include(found.bounds, bounds.box);
  drawn = {map_T_robot, found.bounds, has_ranges(frame), true};
  if (drawn.has_ranges) ++with_ranges_;
  --missing_;
  ++work_;
}

void LiveGridMap::take_out(const Frame& frame, Drawn& drawn) {
  if (!drawn.is_drawn) return;
  tiles_.remove(finder_.find(frame, drawn.map_T_robot));
  drawn.is_drawn = false;
  if (drawn.has_ranges) --with_ranges_;
  ++missing_;
  ++work_;
}

/// Doubles the size of the cells if the map has grown too large. Cells do not become finer again.
void LiveGridMap::use_coarser_cells_if_needed() {
  if (drawn_.empty()) return;
  const double resolution_m = layout_for(bounds(), options_.map).resolution_m;
  if (resolution_m > resolution_m_) start_again(resolution_m);
}

void LiveGridMap::start_again(double resolution_m) {
  resolution_m_ = resolution_m;
  finder_ = FrameCellFinder(options_.map, resolution_m);
  tiles_ = GridTiles();
  for (Drawn& drawn : drawn_) drawn.is_drawn = false;
  missing_ = drawn_.size();
  with_ranges_ = 0;
  superseded_ = 0;
  next_check_ = 0;
  unmoved_ = 0;
}

/// Bounds of all frames at the poses at which they are drawn.
TBoundingBox LiveGridMap::bounds() {
  TBoundingBox all = TBoundingBox::PlusMinusInfinity();
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    if (std::exchange(bounds_[i].may_shrink, false)) {
      bounds_[i].box = TBoundingBox::PlusMinusInfinity();
      const std::size_t end = std::min((i + 1) * kFramesWithBounds, drawn_.size());
      for (std::size_t k = i * kFramesWithBounds; k < end; ++k) include(drawn_[k].bounds, bounds_[i].box);
    }
    include(bounds_[i].box, all);
  }
  return all;
}

GridSnapshot LiveGridMap::snapshot() {
  GridMapOptions map = options_.map;
  map.resolution_m = resolution_m_;
  const TBoundingBox extent = drawn_.empty() ? TBoundingBox({0, 0, 0}, {0, 0, 0}) : bounds();
  return tiles_.snapshot(layout_for(extent, map));
}

}  // namespace psi_slam
