// SPDX-License-Identifier: BSD-3-Clause
#include "replay/map_painter.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLeastRest{300};
constexpr int kRestPerWork = 2;
constexpr int kLargestTexture_px = 4096;

std::shared_ptr<const DrawnMap> draw(const MapSketch& sketch, const GridMapOptions& options) {
  std::vector<Frame> log;
  log.reserve(sketch.frames.size());
  for (const std::size_t frame : sketch.frames) log.push_back(sketch.log[frame]);
  MapPictureOptions picture;
  picture.max_side_px = kLargestTexture_px;
  picture.transparent_unknown = true;
  return std::make_shared<DrawnMap>(
      DrawnMap{map_raster(*draw_grid_map(log, sketch.map_T_robot, options), picture), log.size()});
}

}  // namespace

MapPainter::MapPainter(const GridMapOptions& options)
    : options_(options), thread_(run_in_background([this] { work(); })) {}

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

std::shared_ptr<const DrawnMap> MapPainter::drawn() const {
  const std::lock_guard lock(mutex_);
  return drawn_;
}

void MapPainter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || wanted_; });
    if (stop_) return;
    const MapSketch sketch = std::move(*wanted_);
    wanted_.reset();
    lock.unlock();
    const auto start = Clock::now();
    std::shared_ptr<const DrawnMap> drawn;
    try {
      drawn = draw(sketch, options_);
    } catch (const std::exception&) {  // out of memory: keep the previous drawing
    }
    const auto rest = std::max<Clock::duration>(kLeastRest, kRestPerWork * (Clock::now() - start));
    lock.lock();
    if (drawn) drawn_ = std::move(drawn);
    changed_.wait_for(lock, rest, [this] { return stop_; });
  }
}

}  // namespace psi_slam
