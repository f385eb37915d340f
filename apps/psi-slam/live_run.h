// SPDX-License-Identifier: BSD-3-Clause
// What the commands that read a driving robot share: the end by Ctrl-C, and messages from several threads.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

#include "interrupt_signals.h"
#include "live/live_control.h"
#include "pose_lines.h"
#include "progress_line.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Control of a live source and its messages. The first Ctrl-C ends the source, the second one the work that
/// follows, and the third one the process. The object must outlive the source.
class LiveRun {
 public:
  /// `shows_progress`: whether show() prints progress. `at_interrupt`: sentence that is printed after the
  /// first Ctrl-C, without full stop.
  LiveRun(const Streams& streams, bool shows_progress, std::string at_interrupt);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Lets the source print its notices until end() or leave().
  LiveControl control();

  /// Shows progress while no notice is printed. Call after each scan.
  void show(const SessionProgress& progress);
  std::optional<ProgressLine>& progress_line() { return progress_line_; }

  /// Call after the last frame.
  void end();
  /// Returns whether the work that follows the end of the source shall be cut short: by the second Ctrl-C, or
  /// by the first one if the source has ended without. Call after end().
  const std::atomic<bool>& cuts_short() const { return signals_.came(ended_by_signal_ ? 2 : 1); }
  bool interrupted_twice() const { return signals_.came(2); }

  /// Lets the source end, so that it can be destroyed.
  void leave();

 private:
  void print(const std::string& sentence);
  void print_interrupt();

  const Streams& streams_;
  std::string at_interrupt_;
  InterruptSignals signals_{2};
  void (*previous_pipe_)(int);
  std::atomic<bool> printed_interrupt_ = false;
  bool ended_by_signal_ = false;
  std::atomic<bool> left_ = false;
  std::mutex printing_;
  std::optional<ProgressLine> progress_line_;
};

/// Prints a line with a pose at once.
inline void print_pose(std::ostream& out, const LivePose& pose, PoseFormat format) {
  out << pose_line(pose, format) << std::flush;
}

}  // namespace psi_slam
