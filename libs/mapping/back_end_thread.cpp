// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_thread.h"

#include <system_error>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::size_t kWakingFrames = 32;  // number of waiting frames without a node that wake the thread

}  // namespace

BackEndThread::BackEndThread(GraphBuilder& builder, bool own_thread, ThreadPriority priority)
    : builder_(builder) {
  if (!own_thread) return;
  try {
    thread_ = std::thread([this, priority] {
      set_priority_of_this_thread(priority);
      work();
    });
  } catch (const std::system_error&) {
    // The results are the same without the thread.
  }
}

BackEndThread::~BackEndThread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackEndThread::hand_over(TrackedFrame tracked) {
  ++handed_over_;
  const bool has_node = tracked.step.node.has_value();
  std::unique_lock<std::mutex> lock(mutex_);
  waiting_.push_back(std::move(tracked));
  if (!thread_.joinable() && !failure_) work_off(lock);
  // Frames without a node have little work, so they need not wake the thread one by one.
  const bool is_urgent = has_node || waiting_.size() >= kWakingFrames;
  lock.unlock();
  if (is_urgent) changed_.notify_all();
}

bool BackEndThread::is_ready() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !done_.empty() || failure_;
}

BackEndStep BackEndThread::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (done_.empty()) changed_.notify_all();  // frames without a node did not wake the thread
  changed_.wait(lock, [&] { return !done_.empty() || failure_; });
  if (done_.empty()) std::rethrow_exception(failure_);
  BackEndStep step = std::move(done_.front());
  done_.pop_front();
  ++taken_;
  return step;
}

void BackEndThread::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!failure_) {
    changed_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
    if (stop_) return;
    work_off(lock);
    changed_.notify_all();
  }
}

// Works off the oldest frame that waits. `lock` is released meanwhile.
void BackEndThread::work_off(std::unique_lock<std::mutex>& lock) {
  const TrackedFrame tracked = std::move(waiting_.front());
  waiting_.pop_front();
  lock.unlock();
  try {
    BackEndStep step = builder_.add(tracked);
    lock.lock();
    done_.push_back(std::move(step));
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
  }
}

}  // namespace psi_slam
