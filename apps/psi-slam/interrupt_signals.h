// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>

#include <atomic>

namespace psi_slam {

/// While an object exists, the first SIGINT or SIGTERM makes came() true. The second signal has its default
/// effect: it ends the process. At most one object may exist at a time.
class InterruptSignals {
 public:
  InterruptSignals();
  ~InterruptSignals();
  InterruptSignals(const InterruptSignals&) = delete;
  InterruptSignals& operator=(const InterruptSignals&) = delete;

  const std::atomic<bool>& came() const;

 private:
  struct sigaction previous_interrupt_ = {};
  struct sigaction previous_terminate_ = {};
};

}  // namespace psi_slam
