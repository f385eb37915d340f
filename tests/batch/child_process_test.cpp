// SPDX-License-Identifier: BSD-3-Clause
#include "batch/child_process.h"

#include <gmock/gmock.h>

#include <csignal>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

ChildProcess shell(const std::string& script) {
  ChildProcess child;
  child.words = {"/bin/sh", "-c", script};
  return child;
}

TEST(ChildProcess, gives_its_words_and_what_it_took) {
  const ChildEnd end = run_child(shell("cat; echo result; echo remark >&2"));
  EXPECT_EQ(end.code, 0);
  EXPECT_EQ(end.out, "result\n") << "standard input is empty";
  EXPECT_EQ(end.err, "remark\n");
  EXPECT_EQ(end.failure(), "");
  EXPECT_GT(end.wall_s, 0);
  EXPECT_GT(end.cpu_s, 0);
  EXPECT_GT(end.peak_memory_mib, 0.1);
}

TEST(ChildProcess, does_not_choke_on_many_words) {
  const ChildEnd end =
      run_child(shell("head -c 3000000 /dev/zero; head -c 3000000 /dev/zero >&2; echo end >&2"));
  EXPECT_EQ(end.out.size(), 3'000'000U);
  EXPECT_LT(end.err.size(), 1'000'000U);
  EXPECT_EQ(end.err.substr(end.err.size() - 4), "end\n") << "the last words are kept";
}

TEST(ChildProcess, says_why_it_is_no_success) {
  EXPECT_EQ(run_child(shell("echo first >&2; echo the disk is full >&2; exit 3")).failure(),
            "the disk is full");
  EXPECT_EQ(run_child(shell("exit 3")).failure(), "ended with code 3");
  const ChildEnd killed = run_child(shell("kill -SEGV $$"));
  EXPECT_EQ(killed.signal, SIGSEGV);
  EXPECT_THAT(killed.failure(), HasSubstr("ended by a signal: "));
}

TEST(ChildProcess, is_ended_by_its_time_limit_and_on_request) {
  ChildProcess slow = shell("exec sleep 600");
  slow.time_limit_s = 0.1;
  EXPECT_EQ(run_child(slow).failure(), "stopped at its time limit");
  ChildProcess stopped = shell("exec sleep 600");
  stopped.stop = [] { return true; };
  EXPECT_EQ(run_child(stopped).failure(), "interrupted");
}

TEST(ChildProcess, a_signal_that_comes_meanwhile_is_nothing) {
  static volatile std::sig_atomic_t came = 0;
  struct sigaction count {};
  count.sa_handler = [](int) { came = came + 1; };  // and no SA_RESTART: poll() returns with EINTR
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGUSR1, &count, &before), 0);
  EXPECT_EQ(run_child(shell("echo first; sleep 0.05; kill -USR1 $PPID; sleep 0.05; echo last")).out,
            "first\nlast\n");
  ChildProcess slow = shell("echo first; sleep 0.05; kill -USR1 $PPID; exec sleep 30");
  slow.time_limit_s = 0.3;
  EXPECT_TRUE(run_child(slow).over_time) << "it went on looking at its time";
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_GE(came, 1);
}

TEST(ChildProcess, a_program_that_is_not_there_is_a_failure) {
  ChildProcess none;
  none.words = {"/no/such/program"};
  EXPECT_THROW(run_child(none), SystemFailure);
}

}  // namespace
}  // namespace psi_slam
