// SPDX-License-Identifier: BSD-3-Clause
// Measures the stages of the work: mean, standard deviation and extremes over all calls.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

class StageClock {
 public:
  explicit StageClock(std::string name) { timing_.name = std::move(name); }

  /// Runs `work`, adds its time and returns it in milliseconds.
  template <class Work>
  double time(const Work& work) {
    const double left_out_before_ms = left_out_ms_;
    const double ms = duration_ms(work) - (left_out_ms_ - left_out_before_ms);
    add(ms);
    return ms;
  }

  /// Runs `call` inside time() without counting it, for example to report progress.
  template <class Call>
  auto leave_out(const Call& call) {
    decltype(call()) result{};
    left_out_ms_ += duration_ms([&] { result = call(); });
    return result;
  }

  void add(double ms);
  StageTiming timing() const;

 private:
  template <class Work>
  static double duration_ms(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  StageTiming timing_;
  double left_out_ms_ = 0;
  double squares_about_mean_ = 0;  // Welford's sum
};

}  // namespace psi_slam
