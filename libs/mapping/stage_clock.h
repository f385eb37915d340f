// SPDX-License-Identifier: BSD-3-Clause
// How long each stage of the work takes: mean, spread and extremes over all its calls.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace psi_slam {

/// Time spent in one stage of the work, over all its calls.
struct StageTiming {
  std::string name;  ///< as a person reads it: "match scan to local map"
  std::size_t calls = 0;
  double mean_ms = 0;
  double std_ms = 0;
  double min_ms = 0;
  double max_ms = 0;
  double total_s = 0;
};

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

  /// In the midst of time(): what is called here is no part of the stage, such as telling of it, or a pause.
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
