// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>

#include <atomic>
#include <cstddef>

namespace psi_slam {

/// While an object exists, the first SIGINT or SIGTERM makes came() true, and later signals up to number
/// `expected` make came() of their number true. The signal after them has its default effect: it ends the
/// process. At most one object may exist at a time.
class InterruptSignals {
 public:
  static constexpr std::size_t kMostExpected = 2;

  explicit InterruptSignals(std::size_t expected = 1);
  ~InterruptSignals();
  InterruptSignals(const InterruptSignals&) = delete;
  InterruptSignals& operator=(const InterruptSignals&) = delete;

  /// Returns whether so many signals came; `number` is at most kMostExpected.
  const std::atomic<bool>& came(std::size_t number = 1) const;

 private:
  struct sigaction previous_interrupt_ = {};
  struct sigaction previous_terminate_ = {};
};

}  // namespace psi_slam
