// SPDX-License-Identifier: BSD-3-Clause
// Runs the back end beside the front end: frames are handed over in their order, and their results are taken
// in the same order. The results do not depend on whether there is a thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "base/thread_priority.h"
#include "mapping/graph_builder.h"

namespace psi_slam {

class BackEndThread {
 public:
  /// Without `own_thread`, or if no thread can be started, hand_over() does the work itself. `builder` must
  /// outlive this object.
  BackEndThread(GraphBuilder& builder, bool own_thread, ThreadPriority priority = ThreadPriority::kNormal);
  /// Ends the thread after the frame it works on. Later frames are dropped.
  ~BackEndThread();
  BackEndThread(const BackEndThread&) = delete;
  BackEndThread& operator=(const BackEndThread&) = delete;

  /// Adds a frame to those that wait. A few frames without a node wait for the next node or for take(). Until
  /// in_work() is 0, only this class may use the builder.
  void hand_over(TrackedFrame tracked);

  /// Number of frames that were handed over and whose results were not taken.
  std::size_t in_work() const { return handed_over_ - taken_; }
  /// Number of frames whose results were taken.
  std::size_t taken() const { return taken_; }
  /// Whether take() would not have to wait.
  bool is_ready() const;
  /// Returns the result of the oldest frame in work, and waits for it if necessary. Throws what the builder
  /// threw. At least one frame must be in work.
  BackEndStep take();

 private:
  void work();
  void work_off(std::unique_lock<std::mutex>& lock);

  GraphBuilder& builder_;
  std::size_t handed_over_ = 0;
  std::size_t taken_ = 0;

  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  std::deque<TrackedFrame> waiting_;
  std::deque<BackEndStep> done_;
  std::exception_ptr failure_;  ///< what the builder threw; no further frame is worked off
  bool stop_ = false;

  std::thread thread_;
};

}  // namespace psi_slam
