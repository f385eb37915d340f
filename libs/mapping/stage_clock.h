// SPDX-License-Identifier: BSD-3-Clause
// Measures the time of one stage of the work: mean, standard deviation and extremes over all calls.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

class StageClock {
 public:
  explicit StageClock(std::string name) { timing_.name = std::move(name); }

  /// Runs `work` and adds its time to the statistics. Returns the time in milliseconds.
  template <class Work>
  double time(const Work& work) {
    const double left_out_before_ms = left_out_ms_;
    const double ms = duration_ms(work) - (left_out_ms_ - left_out_before_ms);
    add(ms);
    return ms;
  }

  /// Runs `call` and excludes its time from the enclosing time(). Use it for example to report progress.
  template <class Call>
  auto leave_out(const Call& call) {
    decltype(call()) result{};
    left_out_ms_ += duration_ms([&] { result = call(); });
    return result;
  }

  void add(double ms) {
    ++timing_.calls;
    timing_.total_s += ms * 1e-3;
    timing_.min_ms = timing_.calls == 1 ? ms : std::min(timing_.min_ms, ms);
    timing_.max_ms = timing_.calls == 1 ? ms : std::max(timing_.max_ms, ms);
    const double before = ms - timing_.mean_ms;
    timing_.mean_ms += before / static_cast<double>(timing_.calls);
    squares_about_mean_ += before * (ms - timing_.mean_ms);
  }

  StageTiming timing() const {
    StageTiming timing = timing_;
    if (timing.calls > 0) timing.std_ms = std::sqrt(squares_about_mean_ / static_cast<double>(timing.calls));
    return timing;
  }

 private:
  template <class Work>
  static double duration_ms(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  StageTiming timing_;
  double left_out_ms_ = 0;
  double squares_about_mean_ = 0;  // sum of squared deviations from the mean, by Welford's method
};

}  // namespace psi_slam
