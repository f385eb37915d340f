// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "gui/background_thread.h"
#include "gui/shared_history.h"
#include "map/rendering/map_edits.h"
#include "map/rendering/map_image.h"
#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"
#include "session/settings.h"

namespace psi_slam {

/// The scans and poses that a grid map is drawn from.
struct MapSketch {
  HistoryView<Frame> log;
  std::vector<std::size_t> frames;               ///< indices into `log` of the scans to draw
  std::vector<mrpt::math::TPose2D> map_T_robot;  ///< pose of the robot at each of `frames`
};

/// The zones of one kind.
struct DrawnZones {
  MapEdit::Kind kind = MapEdit::Kind::kKeepOut;
  MapRaster raster;  ///< dark in the zones, transparent elsewhere
};

/// A drawn grid map with its edits, which never changes.
struct DrawnMap {
  MapRaster raster;  ///< transparent where nothing was observed
  std::size_t scans = 0;
  std::vector<DrawnZones> zones{};
};

/// Draws the grid map of a run in a thread of its own, so that neither the mapper nor the window waits.
class MapPainter {
 public:
  /// `frame` is the frame of edits that state none.
  MapPainter(const GridMapOptions& options, MapFrameOptions frame, std::vector<MapEdit> edits);
  /// Waits until the current drawing is finished.
  ~MapPainter() { stop(); }

  /// Asks for a drawing; replaces a request that still waits. After each drawing the thread sleeps twice as
  /// long as it worked, so that it uses at most a third of one processor.
  void request(MapSketch sketch);

  /// Replaces the edits. Applies them at once to the scans that were drawn last.
  void show_edits(std::vector<MapEdit> edits);

  /// Makes the thread start no further drawing.
  void stop();
  /// True once the thread has ended; the destructor then does not wait.
  bool ended() const { return has_ended(thread_); }

  /// The newest drawing, or null if there is none yet. May be called from any thread.
  std::shared_ptr<const DrawnMap> drawn() const;

 private:
  void work();

  const GridMapOptions options_;
  const MapFrameOptions frame_;
  mutable std::mutex mutex_;  // guards the members up to stop_
  std::condition_variable changed_;
  std::optional<MapSketch> wanted_;
  std::vector<MapEdit> edits_;
  bool edits_changed_ = false;
  std::shared_ptr<const DrawnMap> drawn_;
  bool stop_ = false;

  std::future<void> thread_;
};

}  // namespace psi_slam
