// SPDX-License-Identifier: BSD-3-Clause
#include "gui/log_pace.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using namespace std::chrono_literals;

constexpr TimeUs kStart_us = 1'000'000'000;

class LogPaceTest : public testing::Test {
 protected:
  const LogPace::Clock::time_point start_ = LogPace::Clock::time_point(100h);
  LogPace pace_;
};

TEST_F(LogPaceTest, at_speed_1_scans_are_due_at_their_recorded_times) {
  EXPECT_EQ(pace_.due_after(kStart_us, start_), start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 1ms), start_ + 200ms);
  EXPECT_EQ(pace_.due_after(kStart_us + 300'000, start_ + 201ms), start_ + 300ms)
      << "the time that mapping takes does not delay later scans";
}

TEST_F(LogPaceTest, at_speed_5_scans_are_due_five_times_faster) {
  pace_.set_speed(5);
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_), start_ + 40ms);
}

TEST_F(LogPaceTest, at_speed_0_scans_are_due_at_once) {
  pace_.set_speed(0);
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 3ms), start_ + 3ms);
}

TEST_F(LogPaceTest, waits_at_most_one_second_for_gaps_and_for_stamps_that_run_backwards) {
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 3'600'000'000, start_), start_ + 1s);
  EXPECT_EQ(pace_.due_after(kStart_us, start_ + 1s), start_ + 1s);
}

TEST_F(LogPaceTest, a_slow_mapper_catches_up_at_most_one_second) {
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 100'000, start_ + 10s), start_ + 9s);
}

TEST_F(LogPaceTest, after_many_early_scans_waits_at_most_one_second) {
  pace_.due_after(kStart_us, start_);
  LogPace::Clock::time_point due;
  for (int i = 1; i < 100; ++i) due = pace_.due_after(kStart_us + i * 1'000'000, start_);
  EXPECT_EQ(due, start_ + 1s);
}

TEST_F(LogPaceTest, starts_a_new_schedule_after_a_pause) {
  pace_.due_after(kStart_us, start_);
  pace_.restart();
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 1h), start_ + 1h);
  EXPECT_EQ(pace_.due_after(kStart_us + 400'000, start_ + 1h), start_ + 1h + 200ms);
}

}  // namespace
}  // namespace psi_slam
