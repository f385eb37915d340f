// SPDX-License-Identifier: BSD-3-Clause
#include "batch/child_workers.h"

#include <gmock/gmock.h>

#include <atomic>
#include <map>
#include <mutex>

namespace psi_slam {
namespace {

using testing::HasSubstr;

class ChildWorkersTest : public testing::Test {
 protected:
  void run(int processes, const std::vector<ChildWords>& children) {
    local_child_workers(processes)(children, {[this] { return stop_.load(); }, [](std::size_t) {},
                                              [this](std::size_t child, ChildEnd end) {
                                                const std::lock_guard lock(mutex_);
                                                EXPECT_EQ(ends_.count(child), 0U) << "once";
                                                ends_[child] = std::move(end);
                                              }});
  }

  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::map<std::size_t, ChildEnd> ends_;
};

TEST_F(ChildWorkersTest, all_are_run_to_their_ends_also_those_that_fail) {
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

TEST_F(ChildWorkersTest, once_stopped_none_is_begun_and_those_under_way_are_not_told_of) {
  local_child_workers(1)({{"/bin/sleep", "1000"}, {"/bin/echo", "two"}},
                         {[this] { return stop_.load(); }, [this](std::size_t) { stop_ = true; },
                          [this](std::size_t child, ChildEnd end) { ends_[child] = std::move(end); }});
  EXPECT_TRUE(ends_.empty());
}

TEST(ChildTexts, bring_words_and_ends_over_a_wire_whatever_bytes_they_hold) {
  const ChildWords words{"/bin/a b", "caf\xe9", "", "--x=\"1\"\n"};
  EXPECT_EQ(read_child_words(child_words_text(words)), words);
  ChildEnd end;
  end.code = 3;
  end.signal = 9;
  end.over_time = true;
  end.out = std::string("a\0b\xff", 4);
  end.err = "\xe9";
  end.wall_s = 0.1;
  end.cpu_s = 1e-9;
  end.peak_memory_mib = 123.456;
  const ChildEnd read = read_child_end(child_end_text(end));
  EXPECT_EQ(read.code, 3);
  EXPECT_EQ(read.signal, 9);
  EXPECT_TRUE(read.over_time);
  EXPECT_FALSE(read.stopped);
  EXPECT_EQ(read.out, end.out);
  EXPECT_EQ(read.err, end.err);
  EXPECT_EQ(read.wall_s, end.wall_s);
  EXPECT_EQ(read.cpu_s, end.cpu_s);
  EXPECT_EQ(read.peak_memory_mib, end.peak_memory_mib);
}

}  // namespace
}  // namespace psi_slam
