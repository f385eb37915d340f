// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace psi_slam {

/// How far several threads are with a number of tasks, told to one observer: what is being done, and how much
/// of all the work is done. One call at a time.
class TaskProgress {
 public:
  using Observer = std::function<void(const std::string& doing, double done, double all)>;

  TaskProgress(std::size_t tasks, double all_work, const Observer& observer)
      : tasks_(tasks), all_(all_work), observer_(observer) {}

  void tell(const std::string& task) {
    const std::lock_guard lock(mutex_);
    observer_(task + ", " + std::to_string(ended_) + " of " + std::to_string(tasks_) + " runs", done_, all_);
  }

  void end(double work) {
    const std::lock_guard lock(mutex_);
    ++ended_;
    done_ += work;
  }

  /// To be called when no thread is at work.
  std::size_t to_go() const { return tasks_ - ended_; }

 private:
  std::size_t tasks_;
  double all_;
  const Observer& observer_;

  std::mutex mutex_;  // of what follows
  std::size_t ended_ = 0;
  double done_ = 0;
};

}  // namespace psi_slam
