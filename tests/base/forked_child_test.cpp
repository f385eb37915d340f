// SPDX-License-Identifier: BSD-3-Clause
#include "base/forked_child.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace psi_slam {
namespace {

TEST(RunningChild, is_killed_by_its_destructor) {
  const pid_t pid = ::fork();
  if (pid == 0)
    for (;;) ::pause();
  ASSERT_GT(pid, 0);
  { const RunningChild child(pid); }
  EXPECT_EQ(::kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH) << "the destructor waited for the child";
}

TEST(RunningChild, reports_its_exit) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(7);
  ASSERT_GT(pid, 0);
  RunningChild child(pid);
  const EndedChild end = child.wait();
  ASSERT_TRUE(WIFEXITED(end.status));
  EXPECT_EQ(WEXITSTATUS(end.status), 7);
  EXPECT_GT(end.peak_memory_mib, 0);
}

TEST(Pipe, returns_written_bytes_then_the_end) {
  Pipe pipe;
  ASSERT_EQ(::write(pipe.writing(), "words", 5), 5);
  pipe.close_writing();
  std::string text;
  EXPECT_TRUE(pipe.read_to(text));
  EXPECT_FALSE(pipe.read_to(text));
  EXPECT_EQ(text, "words");
}

}  // namespace
}  // namespace psi_slam
