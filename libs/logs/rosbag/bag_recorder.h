// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace psi_slam {

/// Callbacks by which the reader of a growing file asks about the program that records it, and about the
/// user.
struct BagRecorder {
  /// Returns whether the user wants to end the reading.
  std::function<bool()> should_stop;
  /// Waits a moment for more bytes. `waited_s`: seconds that the reader has waited for these bytes so far.
  /// Returns false if the user wants to wait no longer.
  std::function<bool(double waited_s)> wait;
  /// Returns whether the recorder writes no more messages to the file.
  std::function<bool()> is_closed = [] { return false; };
  /// Takes a sentence without full stop on why nothing can be read.
  std::function<void(const std::string&)> notify = [](const std::string&) {};
  /// Seconds without a readable state of the file, after which notify() is called.
  double notice_after_s = 10;
};

}  // namespace psi_slam
