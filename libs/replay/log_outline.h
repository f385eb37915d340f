// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "psi_slam/log_options.h"
#include "psi_slam/time_stamp.h"
#include "session/session_input.h"

namespace psi_slam {

/// Time stamps of all scans of a log, for a time slider. A thread reads them ahead of the mapping.
class LogOutline {
 public:
  LogOutline(const SessionInput& log, const LogOptions& options);
  /// Stops reading and waits for the thread.
  ~LogOutline();
  LogOutline(const LogOutline&) = delete;
  LogOutline& operator=(const LogOutline&) = delete;

  /// Tells the thread to stop reading. Does not wait for it.
  void stop() { stop_ = true; }
  /// True once the thread has ended, so that the destructor does not wait.
  bool ended() const { return ended_; }

  /// Time stamps of all readable scans, in the log's order. Null until they are known. Any thread may call.
  std::shared_ptr<const std::vector<TimeUs>> stamps_us() const;

 private:
  void read(const SessionInput& log, const LogOptions& options);

  std::atomic<bool> stop_{false};
  std::atomic<bool> ended_{false};
  mutable std::mutex mutex_;  // guards stamps_us_
  std::shared_ptr<const std::vector<TimeUs>> stamps_us_;

  std::thread thread_;
};

}  // namespace psi_slam
