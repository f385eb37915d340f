// SPDX-License-Identifier: BSD-3-Clause
#include "base/thread_priority.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

#include "base/worker_pool.h"

namespace psi_slam {
namespace {

int niceness() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
}

constexpr int kLowestPriority = 19;  // niceness that nothing can exceed

int niceness_of_thread(ThreadPriority priority) {
  int result = 0;
  std::thread([&] {
    set_priority_of_this_thread(priority);
    result = niceness();
  }).join();
  return result;
}

TEST(ThreadPriority, a_low_priority_affects_one_thread_only) {
  const int before = niceness();
  if (before == kLowestPriority) GTEST_SKIP() << "the test has the lowest priority already";
  EXPECT_EQ(niceness_of_thread(ThreadPriority::kNormal), before);
  EXPECT_GT(niceness_of_thread(ThreadPriority::kLow), before);
  EXPECT_EQ(niceness(), before);
}

// Slice of time of a thread with this priority; 0 if the kernel has no slices of single threads or does not
// tell them.
std::uint64_t slice_ns(ThreadPriority priority) {
  SchedulingAttributes attributes;
  std::thread([&] {
    set_priority_of_this_thread(priority);
    if (syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0U) != 0) attributes.slice_ns = 0;
  }).join();
  return attributes.slice_ns;
}

TEST(ThreadPriority, a_thread_of_normal_priority_may_interrupt_one_of_low_priority) {
  const std::uint64_t normal_ns = slice_ns(ThreadPriority::kNormal);
  if (normal_ns == 0) GTEST_SKIP() << "Linux before 6.12 has no slices of single threads";
  EXPECT_GT(slice_ns(ThreadPriority::kLow), normal_ns);
}

TEST(ThreadPriority, workers_of_a_pool_have_it_and_its_caller_has_not) {
  const int before = niceness();
  if (before == kLowestPriority) GTEST_SKIP() << "the test has the lowest priority already";
  const auto caller = std::this_thread::get_id();
  WorkerPool pool(2, ThreadPriority::kLow);
  bool seen = false;
  while (!seen) {  // until the worker has taken a task
    pool.run(2, [&](std::size_t) {
      if (std::this_thread::get_id() == caller) return std::this_thread::yield();
      seen = true;
      EXPECT_GT(niceness(), before);
    });
  }
  EXPECT_EQ(niceness(), before);
}

}  // namespace
}  // namespace psi_slam
