// SPDX-License-Identifier: BSD-3-Clause
// Writes map.yaml and map.pgm again and again while the robot drives.
//
//     LiveMapWriter writer(folder.path(), settings.map, settings.live.map_period_s);
//     after each scan:  writer.update(mapper);
//
// The scan costs what changed in the map, see LiveGridMap. A thread of the writer's own writes the files.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "map/rendering/live_grid_map.h"
#include "map/rendering/live_poses.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

class LiveMapWriter {
 public:
  /// Gets a map that is written, in the writing thread.
  using ShowMap = std::function<void(const mrpt::maps::COccupancyGridMap2D&)>;

  /// Writes to an existing folder every `period_s` seconds, if the map has changed. 0: never. Each map is
  /// also given to `show_map`, which may be empty.
  LiveMapWriter(std::filesystem::path folder, const GridMapOptions& map, double period_s,
                ShowMap show_map = {});
  /// Waits until files that are being written are complete. Destroy the writer before the final export.
  ~LiveMapWriter();
  LiveMapWriter(const LiveMapWriter&) = delete;
  LiveMapWriter& operator=(const LiveMapWriter&) = delete;

  /// Draws the new scans of the mapper and some of those that moved, fewer if `hurry` becomes true. If the
  /// period is over, hands the map to the writing thread. Call it in the thread that calls the mapper, before
  /// finish().
  void update(const Mapper& mapper, const LiveGridMap::Hurry& hurry = {});

  /// Draws all scans that moved, as calls of update() do in the time between later scans.
  void settle(const Mapper& mapper);

  /// Writes the map as it is drawn now to another pair of files, in this thread. Throws SystemFailure if it
  /// cannot be written.
  void write_to(const std::filesystem::path& yaml_path);

  /// Why the map could not be written the last time, a sentence without full stop; empty if it was written.
  std::optional<std::string> failure() const;

 private:
  using Clock = std::chrono::steady_clock;

  void hand_over();
  void work();

  const std::filesystem::path folder_;
  const std::chrono::duration<double> period_;
  const ShowMap show_map_;
  LiveGridMap map_;
  LivePoses poses_;
  Clock::time_point last_;       ///< time of the last hand-over
  std::size_t handed_work_ = 0;  ///< map_.work() at the last hand-over

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::optional<GridSnapshot> wanted_;  ///< the map to write next
  std::optional<std::string> failure_;
  bool stop_ = false;

  std::thread thread_;
};

}  // namespace psi_slam
