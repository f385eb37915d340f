// SPDX-License-Identifier: BSD-3-Clause
#include "base/thread_priority.h"

#include <gtest/gtest.h>

#include <thread>

#include "base/worker_pool.h"

namespace psi_slam {
namespace {

int niceness() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
}

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
  EXPECT_EQ(niceness_of_thread(ThreadPriority::kNormal), before);
  EXPECT_GT(niceness_of_thread(ThreadPriority::kLow), before);
  EXPECT_EQ(niceness(), before);
}

TEST(ThreadPriority, workers_of_a_pool_have_it_and_its_caller_has_not) {
  const int before = niceness();
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
