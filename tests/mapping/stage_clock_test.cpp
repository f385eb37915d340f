// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/stage_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

namespace psi_slam {
namespace {

void expect_timing_of(const std::vector<double>& times_ms) {
  StageClock clock("stage");
  for (const double ms : times_ms) clock.add(ms);
  const auto count = static_cast<double>(times_ms.size());
  double sum = 0;
  for (const double ms : times_ms) sum += ms;
  double squares = 0;
  for (const double ms : times_ms) squares += (ms - sum / count) * (ms - sum / count);

  const StageTiming timing = clock.timing();
  EXPECT_EQ(timing.calls, times_ms.size());
  EXPECT_NEAR(timing.mean_ms, sum / count, 1e-9 * sum);
  EXPECT_NEAR(timing.std_ms, std::sqrt(squares / count), 1e-6);
  EXPECT_EQ(timing.min_ms, *std::min_element(times_ms.begin(), times_ms.end()));
  EXPECT_EQ(timing.max_ms, *std::max_element(times_ms.begin(), times_ms.end()));
  EXPECT_NEAR(timing.total_s, sum * 1e-3, 1e-12 * sum);
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

TEST(StageClock, agrees_with_statistics_computed_directly) {
  std::mt19937_64 random(4);
  std::gamma_distribution<double> times_ms(1.5, 20);
  std::vector<double> all;
  for (int i = 0; i < 1000; ++i) all.push_back(times_ms(random));
  expect_timing_of(all);
}

TEST(StageClock, keeps_a_small_spread_about_a_large_mean) {
  std::vector<double> all;
  for (int i = 0; i < 500; ++i) all.push_back(1e7 + (i % 2 == 0 ? 0.5 : -0.5));
  StageClock clock("stage");
  for (const double ms : all) clock.add(ms);
  EXPECT_NEAR(clock.timing().std_ms, 0.5, 1e-6);
}

TEST(StageClock, one_call_is_its_own_mean_and_extremes) {
  expect_timing_of({7.25});
}

TEST(StageClock, left_out_time_does_not_count) {
  StageClock clock("stage");
  double left_out_ms = 0;
  const auto start = std::chrono::steady_clock::now();
  clock.time([&] {
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(clock.leave_out([&] {
        const auto from = std::chrono::steady_clock::now();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        left_out_ms += milliseconds_since(from);
        return true;
      }));
  });
  EXPECT_LE(clock.timing().total_s * 1e3, milliseconds_since(start) - left_out_ms);
  EXPECT_GE(clock.timing().total_s, 0);
}

TEST(StageClock, without_calls_all_values_are_zero) {
  const StageTiming timing = StageClock("close loops").timing();
  EXPECT_EQ(timing.name, "close loops");
  EXPECT_EQ(timing.calls, 0U);
  EXPECT_EQ(timing.mean_ms, 0);
  EXPECT_EQ(timing.std_ms, 0);
  EXPECT_EQ(timing.min_ms, 0);
  EXPECT_EQ(timing.max_ms, 0);
  EXPECT_EQ(timing.total_s, 0);
}

TEST(StageClock, times_the_work_it_runs) {
  StageClock clock("stage");
  int runs = 0;
  const double first_ms = clock.time([&] { ++runs; });
  const double second_ms = clock.time([&] { ++runs; });
  EXPECT_EQ(runs, 2);
  const StageTiming timing = clock.timing();
  EXPECT_EQ(timing.calls, 2U);
  EXPECT_EQ(timing.min_ms, std::min(first_ms, second_ms));
  EXPECT_EQ(timing.max_ms, std::max(first_ms, second_ms));
}

}  // namespace
}  // namespace psi_slam
