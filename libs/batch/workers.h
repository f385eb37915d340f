// SPDX-License-Identifier: BSD-3-Clause
// Threads that carry out orders, several at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/worker_pool.h"

namespace psi_slam {

/// Callbacks of carry_out(). Its threads call them concurrently, each for its own order.
template <class Outcome>
struct WorkWatch {
  std::function<bool()> stop;                      ///< returns true when the work must stop
  std::function<void(std::size_t order)> working;  ///< called a few times a second while an order runs
  std::function<void(std::size_t order, Outcome)>
      finished;  ///< called once for each order that ran to its end
};

/// Carries out the orders, at most `processes` at a time. `make(order, stop)` carries out one order. `make`
/// calls `stop` a few times a second, and returns nothing if `stop` ended the order.
template <class Order, class Outcome, class Make>
void carry_out(const std::vector<Order>& orders, int processes, const Make& make,
               const WorkWatch<Outcome>& watch) {
  if (orders.empty()) return;
  WorkerPool pool(std::clamp(static_cast<int>(orders.size()), 1, processes));
  pool.run(orders.size(), [&](std::size_t index) {
    if (watch.stop()) return;
    auto outcome = make(orders[index], [&] {
      watch.working(index);
      return watch.stop();
    });
    if (outcome) watch.finished(index, *std::move(outcome));
  });
}

/// Receives the name of the current task, the work done and the total work, both in the same unit.
using ProgressObserver = std::function<void(const std::string& doing, double done, double all)>;

/// Progress of a number of tasks that several threads carry out. Calls the observer from one thread at a
/// time.
class TaskProgress {
 public:
  /// `observer` must outlive the object.
  TaskProgress(std::size_t tasks, double all_work, const ProgressObserver& observer)
      : tasks_(tasks), all_(all_work), observer_(observer) {}

  void show(const std::string& task) {
    const std::lock_guard lock(mutex_);
    observer_(task + ", " + std::to_string(ended_) + " of " + std::to_string(tasks_) + " runs", done_, all_);
  }

  void end(double work) {
    const std::lock_guard lock(mutex_);
    ++ended_;
    done_ += work;
  }

  /// Number of tasks that have not ended. Call it when no thread is working.
  std::size_t remaining() const { return tasks_ - ended_; }

 private:
  std::size_t tasks_;
  double all_;
  const ProgressObserver& observer_;

  std::mutex mutex_;  // guards the members below
  std::size_t ended_ = 0;
  double done_ = 0;
};

}  // namespace psi_slam
