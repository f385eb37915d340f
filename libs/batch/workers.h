// SPDX-License-Identifier: BSD-3-Clause
// Workers that carry out orders: threads of this process, or ranks of an MPI job (see apps/mpi). MPI ranks
// exchange orders and outcomes as texts of cbor_text().
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/worker_pool.h"

namespace psi_slam {

/// Callbacks of workers. Workers that are threads call them concurrently, each for its own order.
template <class Outcome>
struct WorkWatch {
  std::function<bool()> stop;                      ///< returns true when the workers must stop
  std::function<void(std::size_t order)> working;  ///< called a few times a second while an order runs
  std::function<void(std::size_t order, Outcome)>
      finished;  ///< called once for each order that ran to its end
};

template <class Order, class Outcome>
using Workers = std::function<void(const std::vector<Order>&, const WorkWatch<Outcome>&)>;

/// Workers that carry out at most `processes` orders at a time. `make(order, stop)` carries out one order.
/// `make` calls `stop` a few times a second, and returns nothing if `stop` ended the order.
template <class Order, class Outcome, class Make>
Workers<Order, Outcome> thread_workers(int processes, Make make) {
  return [processes, make](const std::vector<Order>& orders, const WorkWatch<Outcome>& watch) {
    WorkerPool pool(std::clamp(static_cast<int>(orders.size()), 1, processes));
    pool.run(orders.size(), [&](std::size_t index) {
      if (watch.stop()) return;
      auto outcome = make(orders[index], [&] {
        watch.working(index);
        return watch.stop();
      });
      if (outcome) watch.finished(index, *std::move(outcome));
    });
  };
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

/// CBOR bytes for a message to another process. Unlike JSON text, CBOR keeps file names in any encoding.
inline std::string cbor_text(const nlohmann::json& json) {
  std::string text;
  nlohmann::json::to_cbor(json, text);
  return text;
}

/// Reads a text of cbor_text(). Throws nlohmann::json::exception for other text.
template <class Value>
Value read_cbor(const std::string& text) {
  return nlohmann::json::from_cbor(text).get<Value>();
}

}  // namespace psi_slam
