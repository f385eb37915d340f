// SPDX-License-Identifier: BSD-3-Clause
// Threads that share the work of a loop with independent iterations.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "base/thread_priority.h"

namespace psi_slam {

/// Pieces of work that do not depend on each other.
using Tasks = std::vector<std::function<void()>>;

class WorkerPool {
 public:
  /// `threads` includes the thread that calls run(), so 1 starts no other thread. Values below 1 count as 1.
  /// `priority` is that of the other threads.
  explicit WorkerPool(int threads, ThreadPriority priority = ThreadPriority::kNormal);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(0) .. task(count - 1) in parallel, in any order, and returns when all have ended. If tasks
  /// throw, the remaining tasks still run; then run() throws the exception of the lowest index. Call run()
  /// from one thread at a time, and never from a task.
  void run(std::size_t count, const std::function<void(std::size_t)>& task);
  /// Calls all `tasks` in parallel, as run(count, task) does. Threads take them in their order, so the
  /// longest should be first.
  void run(const Tasks& tasks);

 private:
  void work();
  void take_tasks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;  // guards all following members except workers_
  std::condition_variable changed_;
  const std::function<void(std::size_t)>* task_ = nullptr;  ///< task of the current run()
  std::size_t count_ = 0;
  std::size_t next_ = 0;  ///< first index that no thread has taken
  std::size_t ended_ = 0;
  std::exception_ptr failure_;
  std::size_t failed_index_ = 0;
  bool stop_ = false;

  std::vector<std::thread> workers_;
};

/// Calls task(0) .. task(count - 1) in parallel and returns their results in the order of the indices.
template <class Result, class Task>
std::vector<Result> map_in_parallel(WorkerPool& pool, std::size_t count, const Task& task) {
  std::vector<Result> results(count);
  pool.run(count, [&](std::size_t index) { results[index] = task(index); });
  return results;
}

}  // namespace psi_slam
