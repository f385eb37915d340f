// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace psi_slam {

/// Adds the time from its construction to its destruction to `work_s`, in seconds.
class WorkClock {
 public:
  explicit WorkClock(double& work_s) : work_s_(work_s), before_s_(work_s) {}
  ~WorkClock() { stop(); }
  WorkClock(const WorkClock&) = delete;
  WorkClock& operator=(const WorkClock&) = delete;

  void stop() {
    work_s_ = before_s_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Continues after stop(). The time between stop() and resume() does not count.
  void resume() {
    before_s_ = work_s_;
    start_ = std::chrono::steady_clock::now();
  }

 private:
  double& work_s_;
  double before_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace psi_slam
