// SPDX-License-Identifier: BSD-3-Clause
#include "base/task_thread.h"

#include <system_error>
#include <utility>

namespace psi_slam {

TaskThread::TaskThread(bool own_thread) {
  if (!own_thread) return;
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {
    // The results are the same without the thread.
  }
}

TaskThread::~TaskThread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void TaskThread::start(std::function<void()> task) {
  wait();
  if (!thread_.joinable()) return task();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = std::move(task);
  }
  changed_.notify_all();
}

void TaskThread::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return !task_; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void TaskThread::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || task_; });
    if (!task_) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      task_();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    task_ = nullptr;
    failure_ = failure;
    changed_.notify_all();
  }
}

}  // namespace psi_slam
