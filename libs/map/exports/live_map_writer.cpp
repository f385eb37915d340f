// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/live_map_writer.h"

#include <exception>
#include <utility>

#include "base/thread_priority.h"
#include "map/exports/map_server_pair.h"

namespace psi_slam {
namespace {

LiveGridOptions live_options(const GridMapOptions& map) {
  LiveGridOptions options;
  options.map = map;
  return options;
}

}  // namespace

LiveMapWriter::LiveMapWriter(std::filesystem::path folder, const GridMapOptions& map, double period_s,
                             ShowMap show_map)
    : folder_(std::move(folder)),
      period_(period_s),
      show_map_(std::move(show_map)),
      map_(live_options(map)),
      last_(Clock::now()),
      thread_([this] { work(); }) {}

LiveMapWriter::~LiveMapWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveMapWriter::update(const Mapper& mapper, const LiveGridMap::Hurry& hurry) {
  if (period_.count() == 0) return;
  const std::vector<FrameRecord>& frames = mapper.frames();
  poses_.take(frames);
  const auto map_T_robot = [&](std::size_t i) { return poses_.map_T_robot(i, frames, mapper.node_poses()); };
  map_.update(mapper.log(), map_T_robot, hurry);
  const bool has_news = map_.work() != handed_work_ || failure();
  if (Clock::now() - last_ >= period_ && has_news && map_.is_complete()) hand_over();
}

void LiveMapWriter::settle(const Mapper& mapper) {
  if (period_.count() == 0) return;
  do {
    update(mapper);
  } while (!map_.is_settled());
}

void LiveMapWriter::hand_over() {
  last_ = Clock::now();
  handed_work_ = map_.work();
  GridSnapshot snapshot = map_.snapshot();
  const std::lock_guard lock(mutex_);
  wanted_ = std::move(snapshot);
  changed_.notify_all();
}

void LiveMapWriter::write_to(const std::filesystem::path& yaml_path) {
  write_map_server_pair(yaml_path, *grid_of(map_.snapshot()));
}

std::optional<std::string> LiveMapWriter::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void LiveMapWriter::work() {
  set_priority_of_this_thread(ThreadPriority::kLow);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || wanted_.has_value(); });
    if (stop_) return;
    const GridSnapshot snapshot = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    std::optional<std::string> failure;
    try {
      const auto grid = grid_of(snapshot);
      if (show_map_) show_map_(*grid);
      write_map_server_pair(folder_ / "map.yaml", *grid);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    failure_ = std::move(failure);
  }
}

}  // namespace psi_slam
