// SPDX-License-Identifier: BSD-3-Clause
#include "base/forked_child.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string>

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

TEST(RunningChild, is_waited_for_once) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(0);
  ASSERT_GT(pid, 0);
  RunningChild child(pid);
  child.wait();
  EXPECT_THROW(child.wait(), std::logic_error);
}

TEST(Pipe, reads_exactly_what_is_asked_for_or_reports_the_end) {
  Pipe pipe;
  ASSERT_TRUE(write_all(pipe.writing(), "words"));
  pipe.close_writing();
  std::string text(3, ' ');
  EXPECT_TRUE(pipe.read_exactly(text.data(), text.size()));
  EXPECT_EQ(text, "wor");
  EXPECT_FALSE(pipe.read_exactly(text.data(), text.size()));
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
