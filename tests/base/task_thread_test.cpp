// SPDX-License-Identifier: BSD-3-Clause
#include "base/task_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <vector>

namespace psi_slam {
namespace {

TEST(TaskThread, runs_the_tasks_one_after_the_other) {
  for (const bool own_thread : {false, true}) {
    TaskThread thread(own_thread);
    std::vector<int> order;
    for (int i = 0; i < 100; ++i) thread.start([&order, i] { order.push_back(i); });
    thread.wait();
    ASSERT_EQ(order.size(), 100U);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
  }
}

TEST(TaskThread, works_beside_its_owner) {
  TaskThread thread(true);
  std::atomic<bool> owner_came{false};
  std::thread::id id;
  // The task waits for its owner, which therefore must not wait for the task.
  thread.start([&] {
    id = std::this_thread::get_id();
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!owner_came && std::chrono::steady_clock::now() < give_up) std::this_thread::yield();
  });
  owner_came = true;
  thread.wait();
  EXPECT_NE(id, std::this_thread::get_id());
}

TEST(TaskThread, has_ended_the_task_when_it_is_destroyed) {
  std::atomic<bool> ended{false};
  {
    TaskThread thread(true);
    thread.start([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

TEST(TaskThread, throws_what_a_task_threw_once) {
  const auto fail = [] { throw std::runtime_error("failed"); };
  TaskThread thread(true);
  thread.start(fail);
  EXPECT_THROW(thread.wait(), std::runtime_error);
  EXPECT_NO_THROW(thread.wait());
  thread.start(fail);
  int calls = 0;
  EXPECT_THROW(thread.start([&] { ++calls; }), std::runtime_error);
  EXPECT_NO_THROW(thread.start([&] { ++calls; }));
  thread.wait();
  EXPECT_EQ(calls, 1);

  TaskThread none(false);
  EXPECT_THROW(none.start(fail), std::runtime_error);
  EXPECT_NO_THROW(none.wait());
}

TEST(TaskThread, drops_the_failure_of_its_last_task) {
  TaskThread thread(true);
  thread.start([] { throw std::runtime_error("failed"); });
}

}  // namespace
}  // namespace psi_slam
