// SPDX-License-Identifier: BSD-3-Clause
#include "gui/map_painter.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "map/rendering/placed_edits.h"
#include "session/map_frame.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;
using Grid = mrpt::maps::COccupancyGridMap2D;

constexpr std::chrono::milliseconds kLeastRest{300};
constexpr int kRestPerWork = 2;
constexpr int kLargestTexture_px = 4096;

MapPictureOptions texture_options() {
  MapPictureOptions picture;
  picture.max_side_px = kLargestTexture_px;
  picture.transparent_unknown = true;
  return picture;
}

std::vector<Frame> log_of(const MapSketch& sketch) {
  std::vector<Frame> log;
  log.reserve(sketch.frames.size());
  for (const std::size_t frame : sketch.frames) log.push_back(sketch.log[frame]);
  return log;
}

/// Returns the pose at the last drawn scan up to `scan`; empty if `scan` is not mapped.
std::optional<mrpt::math::TPose2D> pose_at(const MapSketch& sketch, std::size_t scan) {
  const auto later = std::upper_bound(sketch.frames.begin(), sketch.frames.end(), scan);
  if (scan >= sketch.log.size() || later == sketch.frames.begin()) return std::nullopt;
  return sketch.map_T_robot[static_cast<std::size_t>(later - sketch.frames.begin()) - 1];
}

/// Returns the edits that have a place, with their points in the frame of the sketch.
std::vector<MapEdit> placed_in(const MapSketch& sketch, std::vector<MapEdit> edits,
                               const MapFrameOptions& frame) {
  const bool all_state_frames =
      std::all_of(edits.begin(), edits.end(), [](const MapEdit& edit) { return edit.frame_T_robot; });
  mrpt::math::TPose2D edits_T_start;
  if (!all_state_frames) {
    const auto fixed = fixed_export_T_map(frame);
    edits_T_start = robot_in_target(fixed ? *fixed : export_T_map(log_of(sketch), sketch.map_T_robot, frame),
                                    pose_at(sketch, 0).value_or(mrpt::math::TPose2D(0, 0, 0)));
  }
  for (MapEdit& edit : edits) edit = with_frame(std::move(edit), edits_T_start);
  return placed_edits(edits, {}, [&](std::size_t scan) { return pose_at(sketch, scan); }).edits;
}

/// Returns the zones of a kind as they cover the cells of the grid; empty if they cover none.
std::optional<DrawnZones> draw_zones(MapEdit::Kind kind, const std::vector<MapEdit>& edits,
                                     const Grid& grid) {
  if (std::none_of(edits.begin(), edits.end(), [&](const MapEdit& edit) { return edit.kind == kind; }))
    return std::nullopt;
  Grid zones = grid;
  zones.fill(0.5F);
  std::size_t cells = 0;
  for (const MapEdit& edit : edits)
    if (edit.kind == kind)
      cells += for_each_cell_of(edit, zones, [&](int x, int y) { zones.setCell(x, y, 0); });
  if (cells == 0) return std::nullopt;
  return DrawnZones{kind, map_raster(zones, texture_options())};
}

/// Draws a grid map with edits.
std::shared_ptr<const DrawnMap> draw_edited(const Grid& grid, const std::vector<MapEdit>& edits,
                                            std::size_t scans) {
  if (edits.empty()) return std::make_shared<DrawnMap>(DrawnMap{map_raster(grid, texture_options()), scans});
  Grid edited = grid;
  apply_map_edits(edits, edited);
  DrawnMap drawn{map_raster(edited, texture_options()), scans};
  for (const MapEdit::Kind kind : {MapEdit::Kind::kKeepOut, MapEdit::Kind::kSlow})
    if (auto zones = draw_zones(kind, edits, edited)) drawn.zones.push_back(*std::move(zones));
  return std::make_shared<DrawnMap>(std::move(drawn));
}

}  // namespace

MapPainter::MapPainter(const GridMapOptions& options, MapFrameOptions frame, std::vector<MapEdit> edits)
    : options_(options),
      frame_(std::move(frame)),
      edits_(std::move(edits)),
      thread_(run_in_background([this] { work(); })) {}

void MapPainter::stop() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  changed_.notify_all();
}

void MapPainter::request(MapSketch sketch) {
  const std::lock_guard lock(mutex_);
  wanted_ = std::move(sketch);
  changed_.notify_all();
}

void MapPainter::show_edits(std::vector<MapEdit> edits) {
  const std::lock_guard lock(mutex_);
  edits_ = std::move(edits);
  edits_changed_ = true;
  changed_.notify_all();
}

std::shared_ptr<const DrawnMap> MapPainter::drawn() const {
  const std::lock_guard lock(mutex_);
  return drawn_;
}

void MapPainter::work() {
  Grid::Ptr grid;    // the map that was drawn last, without edits
  MapSketch sketch;  // what it was drawn from
  Clock::time_point rested_at = Clock::now();
  std::unique_lock lock(mutex_);
  while (true) {
    const auto may_draw = [&] { return wanted_ && Clock::now() >= rested_at; };
    const auto has_work = [&] { return stop_ || edits_changed_ || may_draw(); };
    if (wanted_)
      changed_.wait_until(lock, rested_at, has_work);
    else
      changed_.wait(lock, [&] { return wanted_ || has_work(); });
    if (stop_) return;
    if (!has_work()) continue;
    std::optional<MapSketch> to_draw;
    if (may_draw()) to_draw = std::exchange(wanted_, std::nullopt);
    const bool draws = to_draw.has_value();
    const std::vector<MapEdit> edits = edits_;
    edits_changed_ = false;
    lock.unlock();
    const auto start = Clock::now();
    std::shared_ptr<const DrawnMap> drawn;
    try {
      if (to_draw) {
        grid = draw_grid_map(log_of(*to_draw), to_draw->map_T_robot, options_);
        sketch = *std::move(to_draw);
      }
      if (grid) drawn = draw_edited(*grid, placed_in(sketch, edits, frame_), sketch.frames.size());
    } catch (const std::exception&) {  // out of memory: keep the previous drawing
    }
    const auto end = Clock::now();
    if (draws) rested_at = end + std::max<Clock::duration>(kLeastRest, kRestPerWork * (end - start));
    lock.lock();
    if (drawn) drawn_ = std::move(drawn);
  }
}

}  // namespace psi_slam
