// SPDX-License-Identifier: BSD-3-Clause
#include "live_run.h"

#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

namespace psi_slam {
namespace {

class LiveRunTest : public testing::Test {
 protected:
  std::ostringstream out_;
  std::ostringstream err_;
  Streams streams_{out_, err_, false};
};

TEST_F(LiveRunTest, the_first_interrupt_ends_the_source_and_the_second_one_the_work_after_it) {
  LiveRun run(streams_, false, "finishing");
  const LiveControl control = run.control();
  EXPECT_FALSE(control.should_stop());
  raise(SIGINT);
  EXPECT_TRUE(control.should_stop());
  EXPECT_TRUE(control.should_stop());
  EXPECT_EQ(err_.str(), "psi-slam: finishing\n");
  raise(SIGTERM);  // while scans that came before are mapped
  run.end();
  EXPECT_TRUE(run.cuts_short());
  EXPECT_EQ(err_.str(), "psi-slam: finishing\n");
}

TEST_F(LiveRunTest, one_interrupt_does_not_cut_the_work_short) {
  LiveRun run(streams_, false, "finishing");
  raise(SIGINT);
  run.end();
  EXPECT_EQ(err_.str(), "psi-slam: finishing\n") << "also if the source has not looked";
  EXPECT_FALSE(run.cuts_short());
  EXPECT_FALSE(run.interrupted_twice());
}

TEST_F(LiveRunTest, the_first_interrupt_after_the_source_cuts_the_work_short) {
  LiveRun run(streams_, false, "finishing");
  run.end();
  EXPECT_FALSE(run.cuts_short());
  raise(SIGINT);
  EXPECT_TRUE(run.cuts_short());
}

TEST_F(LiveRunTest, ignores_closed_pipes_while_it_exists) {
  {
    const LiveRun run(streams_, false, "");
    EXPECT_EQ(raise(SIGPIPE), 0) << "without ending the process";
  }
  EXPECT_EQ(std::signal(SIGPIPE, SIG_DFL), SIG_DFL);
}

}  // namespace
}  // namespace psi_slam
