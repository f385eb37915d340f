// SPDX-License-Identifier: BSD-3-Clause
#include "base/worker_pool.h"

#include <system_error>
#include <utility>

namespace psi_slam {

WorkerPool::WorkerPool(int threads, ThreadPriority priority) {
  try {
    for (int i = 1; i < threads; ++i)
      workers_.emplace_back([this, priority] {
        set_priority_of_this_thread(priority);
        work();
      });
  } catch (const std::system_error&) {
    // The system provides no further threads; the existing ones do all the work.
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::run(std::size_t count, const std::function<void(std::size_t)>& task) {
  std::unique_lock<std::mutex> lock(mutex_);
  task_ = &task;
  count_ = count;
  next_ = ended_ = 0;
  failure_ = nullptr;
  if (count > 1) changed_.notify_all();
  take_tasks(lock);
  changed_.wait(lock, [&] { return ended_ == count_; });
  task_ = nullptr;
  count_ = next_ = ended_ = 0;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void WorkerPool::run(const Tasks& tasks) {
  run(tasks.size(), [&](std::size_t index) { tasks[index](); });
}

void WorkerPool::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || next_ < count_; });
    if (stop_) return;
    take_tasks(lock);
  }
}

void WorkerPool::take_tasks(std::unique_lock<std::mutex>& lock) {
  while (next_ < count_) {
    const std::size_t index = next_++;
    std::exception_ptr failure;
    lock.unlock();
    try {
      (*task_)(index);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && (!failure_ || index < failed_index_)) {
      failure_ = failure;
      failed_index_ = index;
    }
    if (++ended_ == count_) changed_.notify_all();
  }
}

}  // namespace psi_slam
