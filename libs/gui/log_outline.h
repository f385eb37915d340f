// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "gui/background_thread.h"
#include "psi_slam/time_stamp.h"
#include "session/session_input.h"

namespace psi_slam {

/// Time stamps of all scans of a log, for a time slider. A thread of its own reads the log ahead of the
/// mapping.
class LogOutline {
 public:
  LogOutline(const SessionInput& log, const LogOptions& options)
      : stamps_us_(run_in_background([this, log, options] { return read(log, options); })) {}
  /// Stops reading and waits for the thread.
  ~LogOutline() { stop(); }

  /// Tells the thread to stop reading. Does not wait for it.
  void stop() { stop_ = true; }
  /// True once the thread has ended; the destructor then does not wait.
  bool ended() const { return has_ended(stamps_us_); }

  using Stamps = std::shared_ptr<const std::vector<TimeUs>>;
  /// Time stamps of all readable scans, in the log's order. Null until the thread has read the whole log. May
  /// be called from any thread.
  Stamps stamps_us() const { return ended() ? stamps_us_.get() : nullptr; }

 private:
  Stamps read(const SessionInput& log, const LogOptions& options) const {
    auto stamps_us = std::make_shared<std::vector<TimeUs>>();
    try {
      const auto source = log.open(options);
      for (std::optional<Frame> frame; !stop_ && (frame = source->next());)
        stamps_us->push_back(frame->time_us);
    } catch (const std::exception&) {  // the mapping reports the same error
    }
    return stamps_us;
  }

  std::atomic<bool> stop_{false};
  std::shared_future<Stamps> stamps_us_;
};

}  // namespace psi_slam
