// SPDX-License-Identifier: BSD-3-Clause
#include "batch/child_process.h"

#include <gmock/gmock.h>

#include <atomic>
#include <csignal>
#include <map>
#include <mutex>

#include "batch/workers.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

ChildProcess shell(const std::string& script) {
  ChildProcess child;
  child.words = {"/bin/sh", "-c", script};
  return child;
}

TEST(ChildProcess, reports_output_time_and_memory) {
  const ChildEnd end = run_child(shell("cat; echo result; echo remark >&2"));
  EXPECT_EQ(end.code, 0);
  EXPECT_EQ(end.out, "result\n") << "standard input is empty";
  EXPECT_EQ(end.err, "remark\n");
  EXPECT_EQ(end.failure(), "");
  EXPECT_GT(end.wall_s, 0);
  EXPECT_GT(end.cpu_s, 0);
  EXPECT_GT(end.peak_memory_mib, 0.1);
}

TEST(ChildProcess, keeps_the_end_of_long_output) {
  const ChildEnd end =
      run_child(shell("head -c 3000000 /dev/zero; head -c 3000000 /dev/zero >&2; echo end >&2"));
  EXPECT_EQ(end.out.size(), 3'000'000U);
  EXPECT_LT(end.err.size(), 1'000'000U);
  EXPECT_EQ(end.err.substr(end.err.size() - 4), "end\n") << "the last bytes are kept";
}

TEST(ChildProcess, reports_the_reason_of_a_failure) {
  EXPECT_EQ(run_child(shell("echo first >&2; echo the disk is full >&2; exit 3")).failure(),
            "the disk is full");
  EXPECT_EQ(run_child(shell("exit 3")).failure(), "ended with code 3");
  const ChildEnd killed = run_child(shell("kill -SEGV $$"));
  EXPECT_EQ(killed.signal, SIGSEGV);
  EXPECT_THAT(killed.failure(), HasSubstr("ended by a signal: "));
}

TEST(ChildProcess, is_killed_at_its_time_limit_and_on_request) {
  ChildProcess slow = shell("exec sleep 600");
  slow.time_limit_s = 0.1;
  EXPECT_EQ(run_child(slow).failure(), "stopped at its time limit");
  ChildProcess stopped = shell("exec sleep 600");
  stopped.stop = [] { return true; };
  EXPECT_EQ(run_child(stopped).failure(), "interrupted");
}

TEST(ChildProcess, ignores_signals_to_the_caller) {
  static volatile std::sig_atomic_t received = 0;
  struct sigaction count {};
  count.sa_handler = [](int) { received = received + 1; };  // no SA_RESTART: poll() returns with EINTR
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGUSR1, &count, &before), 0);
  EXPECT_EQ(run_child(shell("echo first; sleep 0.05; kill -USR1 $PPID; sleep 0.05; echo last")).out,
            "first\nlast\n");
  ChildProcess slow = shell("echo first; sleep 0.05; kill -USR1 $PPID; exec sleep 30");
  slow.time_limit_s = 0.3;
  EXPECT_TRUE(run_child(slow).over_time) << "the time limit still applies";
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_GE(received, 1);
}

TEST(ChildProcess, a_missing_program_is_a_system_failure) {
  ChildProcess none;
  none.words = {"/no/such/program"};
  EXPECT_THROW(run_child(none), SystemFailure);
}

class ChildWorkersTest : public testing::Test {
 protected:
  void run(int processes, const std::vector<ChildWords>& children) {
    carry_out(children, processes, run_to_end,
              WorkWatch<ChildEnd>{[this] { return stop_.load(); }, [](std::size_t) {},
                                  [this](std::size_t child, ChildEnd end) {
                                    const std::lock_guard lock(mutex_);
                                    EXPECT_EQ(ends_.count(child), 0U) << "each program ends once";
                                    ends_[child] = std::move(end);
                                  }});
  }

  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::map<std::size_t, ChildEnd> ends_;
};

TEST_F(ChildWorkersTest, all_programs_run_to_their_end_even_after_a_failure) {
  run(2, {{"/bin/echo", "one"},
          {"/bin/sh", "-c", "echo why >&2; exit 3"},
          {"/nowhere/at-all"},
          {"/bin/echo", "four"}});
  ASSERT_EQ(ends_.size(), 4U);
  EXPECT_EQ(ends_[0].out, "one\n");
  EXPECT_EQ(ends_[1].failure(), "why");
  EXPECT_THAT(ends_[2].failure(), HasSubstr("/nowhere/at-all"));
  EXPECT_EQ(ends_[3].failure(), "");
}

TEST_F(ChildWorkersTest, after_a_stop_no_program_starts_and_killed_ones_are_not_reported) {
  carry_out(std::vector<ChildWords>{{"/bin/sleep", "1000"}, {"/bin/echo", "two"}}, 1, run_to_end,
            WorkWatch<ChildEnd>{[this] { return stop_.load(); }, [this](std::size_t) { stop_ = true; },
                                [this](std::size_t child, ChildEnd end) { ends_[child] = std::move(end); }});
  EXPECT_TRUE(ends_.empty());
}

}  // namespace
}  // namespace psi_slam
