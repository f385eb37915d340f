// SPDX-License-Identifier: BSD-3-Clause
// A thread for work beside that of its owner, one task at a time.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace psi_slam {

class TaskThread {
 public:
  /// Without `own_thread`, or if the system provides no further thread, start() runs the task itself.
  explicit TaskThread(bool own_thread);
  /// Waits for the running task and ignores its exception.
  ~TaskThread();
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  /// Starts a task. Waits for the previous task. If that threw, rethrows the exception and does not start
  /// `task`.
  void start(std::function<void()> task);
  /// Waits until no task runs. Rethrows the exception of the last task, once.
  void wait();

 private:
  void work();

  std::mutex mutex_;  // guards all following members except thread_
  std::condition_variable changed_;
  std::function<void()> task_;  ///< the running task, or the next one; otherwise empty
  std::exception_ptr failure_;
  bool stop_ = false;

  std::thread thread_;
};

}  // namespace psi_slam
