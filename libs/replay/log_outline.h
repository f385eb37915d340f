// SPDX-License-Identifier: BSD-3-Clause
// How many scans a log holds and when each was taken, found out ahead of the mapping in a thread of its own:
// what a time slider needs.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "psi_slam/log_options.h"
#include "session/session_input.h"

namespace psi_slam {

class LogOutline {
 public:
  LogOutline(const SessionInput& log, const LogOptions& options);
  ~LogOutline();
  LogOutline(const LogOutline&) = delete;
  LogOutline& operator=(const LogOutline&) = delete;

  /// Reads no further.
  void stop() { stop_ = true; }
  /// The thread has come to its end: the destructor will not wait.
  bool ended() const { return ended_; }

  /// The stamps of all scans that can be read, in the log's order; null until they are known. Called by any
  /// thread.
  std::shared_ptr<const std::vector<TimeUs>> stamps_us() const;

 private:
  void read(const SessionInput& log, const LogOptions& options);

  std::atomic<bool> stop_{false};
  std::atomic<bool> ended_{false};
  mutable std::mutex mutex_;  // of what follows
  std::shared_ptr<const std::vector<TimeUs>> stamps_us_;

  std::thread thread_;
};

}  // namespace psi_slam
