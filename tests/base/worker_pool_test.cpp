// SPDX-License-Identifier: BSD-3-Clause
#include "base/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

namespace psi_slam {
namespace {

TEST(WorkerPool, calls_every_task_once) {
  for (const int threads : {-1, 1, 2, 5}) {
    WorkerPool pool(threads);
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      pool.run(count, [&](std::size_t i) { ++calls[i]; });
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(calls[i], 1) << i << " of " << count;
    }
  }
}

TEST(WorkerPool, calls_tasks_of_a_list) {
  WorkerPool pool(2);
  std::atomic<int> sum{0};
  pool.run(Tasks{[&] { sum += 1; }, [&] { sum += 20; }, [&] { sum += 300; }});
  EXPECT_EQ(sum, 321);
  EXPECT_NO_THROW(pool.run(Tasks{}));
}

TEST(WorkerPool, has_ended_all_tasks_when_it_returns) {
  WorkerPool pool(3);
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> ended{0};
    pool.run(4, [&](std::size_t) {
      std::this_thread::yield();
      ++ended;
    });
    ASSERT_EQ(ended, 4);
  }
}

TEST(WorkerPool, several_threads_work_at_a_time) {
  WorkerPool pool(3);
  EXPECT_EQ(pool.threads(), 3);
  std::atomic<int> waiting{0};
  // Each task waits until all three have started, which takes three threads.
  pool.run(3, [&](std::size_t) {
    ++waiting;
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (waiting < 3 && std::chrono::steady_clock::now() < give_up) std::this_thread::yield();
  });
  EXPECT_EQ(waiting, 3);
}

TEST(WorkerPool, one_thread_is_the_callers_own) {
  WorkerPool pool(1);
  EXPECT_EQ(pool.threads(), 1);
  std::set<std::thread::id> threads;
  pool.run(10, [&](std::size_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST(WorkerPool, the_exception_of_the_lowest_index_reaches_the_caller_after_all_tasks) {
  for (const int threads : {1, 4}) {
    WorkerPool pool(threads);
    for (int round = 0; round < 50; ++round) {
      std::atomic<int> calls{0};
      try {
        pool.run(20, [&](std::size_t i) {
          ++calls;
          if (i % 7 == 3) throw std::runtime_error(std::to_string(i));
        });
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "3");
      }
      EXPECT_EQ(calls, 20);
    }
    int calls = 0;
    pool.run(1, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 1) << "the pool still works after an exception";
  }
}

TEST(WorkerPool, results_are_in_the_order_of_their_index) {
  WorkerPool pool(4);
  const auto squares = map_in_parallel<std::unique_ptr<std::size_t>>(pool, 300, [](std::size_t i) {
    if (i % 3 == 0) std::this_thread::yield();
    return std::make_unique<std::size_t>(i * i);
  });
  ASSERT_EQ(squares.size(), 300U);
  for (std::size_t i = 0; i < squares.size(); ++i) EXPECT_EQ(*squares[i], i * i);
}

}  // namespace
}  // namespace psi_slam
