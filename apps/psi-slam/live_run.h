// SPDX-License-Identifier: BSD-3-Clause
// What the commands that read a driving robot share: the end by Ctrl-C, and messages from several threads.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <ostream>

#include "interrupt_signals.h"
#include "live/live_control.h"
#include "pose_lines.h"
#include "progress_line.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Control of a live source and its messages. The first Ctrl-C ends the source, a later one the work that
/// follows. The object must outlive the source.
class LiveRun {
 public:
  /// `shows_progress`: whether show() does anything.
  LiveRun(const Streams& streams, bool shows_progress);

  /// Lets the source print its notices until end() or leave().
  LiveControl control();

  /// Shows progress while no notice is printed.
  void show(const SessionProgress& progress);
  std::optional<ProgressLine>& progress_line() { return progress_line_; }

  /// Call after the last frame. Returns whether Ctrl-C ended the source. The next Ctrl-C makes interrupted()
  /// true.
  bool end();
  const std::atomic<bool>& interrupted() const { return signals_->came(); }

  /// Lets the source end, so that it can be destroyed.
  void leave();

 private:
  const Streams& streams_;
  std::optional<InterruptSignals> signals_;
  std::atomic<bool> left_ = false;
  std::mutex printing_;
  std::optional<ProgressLine> progress_line_;
};

/// Prints a line with a pose at once.
inline void print_pose(std::ostream& out, const LivePose& pose, PoseFormat format) {
  out << pose_line(pose, format) << std::flush;
}

}  // namespace psi_slam
