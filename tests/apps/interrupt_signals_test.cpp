// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt_signals.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

void (*handler_of(int signal_number))(int) {
  struct sigaction action = {};
  sigaction(signal_number, nullptr, &action);
  return action.sa_handler;
}

TEST(InterruptSignals, the_first_sets_a_flag_and_the_next_ends_the_process) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const InterruptSignals signals;
    EXPECT_FALSE(signals.came());
    EXPECT_NE(handler_of(signal_number), SIG_DFL);
    raise(signal_number);
    EXPECT_TRUE(signals.came());
    EXPECT_EQ(handler_of(SIGINT), SIG_DFL);
    EXPECT_EQ(handler_of(SIGTERM), SIG_DFL);
  }
}

TEST(InterruptSignals, counts_as_many_as_are_expected) {
  const InterruptSignals signals(2);
  raise(SIGINT);
  EXPECT_TRUE(signals.came());
  EXPECT_FALSE(signals.came(2));
  EXPECT_NE(handler_of(SIGTERM), SIG_DFL);
  raise(SIGTERM);
  EXPECT_TRUE(signals.came(2));
  EXPECT_EQ(handler_of(SIGINT), SIG_DFL);
  EXPECT_EQ(handler_of(SIGTERM), SIG_DFL);
}

TEST(InterruptSignals, leaves_signals_as_they_were) {
  signal(SIGINT, SIG_IGN);
  {
    const InterruptSignals signals;
    EXPECT_NE(handler_of(SIGINT), SIG_IGN);
  }
  EXPECT_EQ(handler_of(SIGINT), SIG_IGN);
  signal(SIGINT, SIG_DFL);
}

}  // namespace
}  // namespace psi_slam
