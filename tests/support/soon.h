// SPDX-License-Identifier: BSD-3-Clause
// Test helper that waits for the work of another thread or process.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace psi_slam {

/// Waits until a condition holds, at most a minute. Returns whether it holds.
inline bool soon(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace psi_slam
