// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_thread.h"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

namespace psi_slam {

BackEndThread::BackEndThread(GraphBuilder& builder, bool own_thread) : builder_(builder) {
  if (own_thread) thread_ = std::thread([this] { work(); });
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
  if (!thread_.joinable()) {
    done_.push_back(builder_.add(tracked));
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(tracked));
  }
  changed_.notify_all();
}

bool BackEndThread::is_ready() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !done_.empty();
}

BackEndStep BackEndThread::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return !done_.empty() || failure_; });
  if (done_.empty()) std::rethrow_exception(failure_);
  BackEndStep step = std::move(done_.front());
  done_.pop_front();
  ++taken_;
  return step;
}

void BackEndThread::work() {
  constexpr int kNiceness = 10;  // the front end answers first if both share a processor
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);  // on Linux, affects one thread only
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
    if (stop_) return;
    const TrackedFrame tracked = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    BackEndStep step;
    std::exception_ptr failure;
    try {
      step = builder_.add(tracked);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    if (!failure) done_.push_back(std::move(step));
    changed_.notify_all();
    if (failure) return;
  }
}

}  // namespace psi_slam
