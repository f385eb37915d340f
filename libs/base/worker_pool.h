// SPDX-License-Identifier: BSD-3-Clause
// Threads that share the work of a loop whose rounds do not depend on each other.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace psi_slam {

class WorkerPool {
 public:
  /// With the thread that calls run(), which works too: 1 starts none. Less than 1 is 1.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(0) .. task(count - 1), each once, in any order and several at a time; returns when all have
  /// ended. Where some throw, all the others are called nevertheless, and then the exception of the lowest
  /// index is thrown. To be called by one thread at a time, and not from within a task.
  void run(std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  void work();
  void take_tasks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;  // of all that follows but the threads
  std::condition_variable changed_;
  const std::function<void(std::size_t)>* task_ = nullptr;  ///< of the call of run() under way
  std::size_t count_ = 0;
  std::size_t next_ = 0;  ///< the first index that nobody has taken
  std::size_t ended_ = 0;
  std::exception_ptr failure_;
  std::size_t failed_index_ = 0;
  bool stop_ = false;

  std::vector<std::thread> workers_;
};

/// The results of task(0) .. task(count - 1), in this order.
template <class Result, class Task>
std::vector<Result> map_in_parallel(WorkerPool& pool, std::size_t count, const Task& task) {
  std::vector<Result> results(count);
  pool.run(count, [&](std::size_t index) { results[index] = task(index); });
  return results;
}

}  // namespace psi_slam
