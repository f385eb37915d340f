// SPDX-License-Identifier: BSD-3-Clause
#include "replay/log_pace.h"

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

TEST_F(LogPaceTest, scans_come_as_they_were_recorded) {
  EXPECT_EQ(pace_.due_after(kStart_us, start_), start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 1ms), start_ + 200ms);
  EXPECT_EQ(pace_.due_after(kStart_us + 300'000, start_ + 201ms), start_ + 300ms)
      << "what mapping takes does not add up";
}

TEST_F(LogPaceTest, or_so_many_times_faster) {
  pace_.set_speed(5);
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_), start_ + 40ms);
}

TEST_F(LogPaceTest, or_at_once) {
  pace_.set_speed(0);
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 3ms), start_ + 3ms);
}

TEST_F(LogPaceTest, gaps_and_stamps_that_run_backwards_are_not_waited_for) {
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 3'600'000'000, start_), start_ + 1s);
  EXPECT_EQ(pace_.due_after(kStart_us, start_ + 1s), start_ + 1s);
}

TEST_F(LogPaceTest, a_mapper_that_fell_behind_is_not_hurried_for_long) {
  pace_.due_after(kStart_us, start_);
  EXPECT_EQ(pace_.due_after(kStart_us + 100'000, start_ + 10s), start_ + 9s);
}

TEST_F(LogPaceTest, what_was_hurried_through_is_not_waited_for_afterwards) {
  pace_.due_after(kStart_us, start_);
  LogPace::Clock::time_point due;
  for (int i = 1; i < 100; ++i) due = pace_.due_after(kStart_us + i * 1'000'000, start_);
  EXPECT_EQ(due, start_ + 1s);
}

TEST_F(LogPaceTest, after_a_pause_time_begins_anew) {
  pace_.due_after(kStart_us, start_);
  pace_.restart();
  EXPECT_EQ(pace_.due_after(kStart_us + 200'000, start_ + 1h), start_ + 1h);
  EXPECT_EQ(pace_.due_after(kStart_us + 400'000, start_ + 1h), start_ + 1h + 200ms);
}

}  // namespace
}  // namespace psi_slam
