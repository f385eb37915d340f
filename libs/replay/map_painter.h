// SPDX-License-Identifier: BSD-3-Clause
// Draws the gridmap of a run while it goes on, in a thread of its own: neither the mapper nor a window waits
// for it.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "psi_slam/frame.h"
#include "replay/shared_history.h"
#include "psi_slam/grid_map.h"
#include "rendering/map_image.h"

namespace psi_slam {

/// What the gridmap is to show.
struct MapSketch {
  HistoryView<Frame> log;
  std::vector<std::size_t> frames;               ///< of the log, those that are drawn
  std::vector<mrpt::math::TPose2D> map_T_robot;  ///< of each
};

/// A gridmap that was drawn; it never changes.
struct DrawnMap {
  MapRaster raster;  ///< transparent where nothing was seen
  std::size_t scans = 0;
};

class MapPainter {
 public:
  explicit MapPainter(const GridMapOptions& options);
  /// Waits for a drawing under way.
  ~MapPainter();
  MapPainter(const MapPainter&) = delete;
  MapPainter& operator=(const MapPainter&) = delete;

  /// Asks for a drawing. The newest request replaces one that waits: drawing takes a share of one processor
  /// only, so that large maps are drawn less often.
  void request(MapSketch sketch);

  /// No drawing is begun any more.
  void stop();
  /// The thread has come to its end: the destructor will not wait.
  bool ended() const { return ended_; }

  /// The newest drawing, or null. Called by any thread.
  std::shared_ptr<const DrawnMap> drawn() const;

 private:
  void work();

  const GridMapOptions options_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::optional<MapSketch> wanted_;
  std::shared_ptr<const DrawnMap> drawn_;
  bool stop_ = false;

  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace psi_slam
