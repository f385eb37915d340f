// SPDX-License-Identifier: BSD-3-Clause
// What the commands that read a driving robot share: its end by Ctrl-C, and messages from several threads.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

#include "interrupt_signals.h"
#include "live/live_control.h"
#include "pose_lines.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Control of a live source. The first Ctrl-C ends the source; end() makes the next one available for the
/// work that follows. Messages of the source and of this thread do not mix. The object must outlive the
/// source; leave() lets the source be destroyed at any time.
class LiveRun {
 public:
  explicit LiveRun(const Streams& streams);

  LiveControl control();

  /// Sets the function that erases a line of progress before a message.
  void set_before_message(std::function<void()> before_message) {
    before_message_ = std::move(before_message);
  }

  /// Prints to the error stream while no other thread does.
  void print(const std::function<void()>& print);

  /// Prints a line with a pose at once.
  static void print(std::ostream& out, const LivePose& pose, PoseFormat format) {
    out << pose_line(pose, format) << std::flush;
  }

  /// Call after the last frame. Returns whether Ctrl-C ended the source. The next Ctrl-C makes interrupted()
  /// true.
  bool end();
  const std::atomic<bool>& interrupted() const { return signals_->came(); }

  /// Lets the source end.
  void leave() { left_ = true; }

 private:
  const Streams& streams_;
  std::optional<InterruptSignals> signals_;
  std::atomic<bool> left_ = false;
  std::mutex printing_;
  std::function<void()> before_message_ = [] {};
};

}  // namespace psi_slam
