// SPDX-License-Identifier: BSD-3-Clause
#include "session/read_ahead.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace psi_slam {

ReadAhead::ReadAhead(std::unique_ptr<FrameSource> source, std::size_t capacity)
    : source_(std::move(source)),
      capacity_(std::max<std::size_t>(capacity, 1)),
      progress_(source_->progress()),
      skipped_(source_->skipped_lines()),
      assumptions_(source_->assumptions()) {
  try {
    thread_ = std::thread([this] { read_all(); });
  } catch (const std::system_error&) {
    // Then next() reads.
  }
}

ReadAhead::~ReadAhead() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<Frame> ReadAhead::next() {
  Read read = thread_.joinable() ? take() : read_one();
  progress_ = read.progress;
  skipped_ = read.skipped;
  assumptions_ = std::move(read.assumptions);
  if (read.failure) std::rethrow_exception(read.failure);
  return std::move(read.frame);
}

bool ReadAhead::is_ready() const {
  if (!thread_.joinable()) return source_->is_ready();
  const std::lock_guard lock(mutex_);
  return !ahead_.empty() || failure_;
}

// Takes the oldest entry of the queue, and waits for it if necessary. The last one stays in the queue for
// further calls.
ReadAhead::Read ReadAhead::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ahead_.empty() || failure_; });
  if (ahead_.empty()) std::rethrow_exception(failure_);
  if (!ahead_.front().frame) return ahead_.front();
  Read read = std::move(ahead_.front());
  ahead_.pop_front();
  // The reader waits only if the queue is full, so the queue passes through this size before it is empty.
  const bool wakes_reader = ahead_.size() == capacity_ / 2;
  lock.unlock();
  if (wakes_reader) changed_.notify_all();
  return read;
}

void ReadAhead::read_all() {
  try {
    bool more = true;
    while (more) {
      Read read = read_one();
      more = read.frame.has_value();
      std::unique_lock lock(mutex_);
      // Waits for room for many frames, because to wake a thread can take longer than to read a frame.
      if (ahead_.size() == capacity_)
        changed_.wait(lock, [this] { return stop_ || ahead_.size() <= capacity_ / 2; });
      if (stop_) return;
      ahead_.push_back(std::move(read));
      lock.unlock();
      changed_.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
  }
}

ReadAhead::Read ReadAhead::read_one() {
  Read read;
  try {
    read.frame = source_->next();
  } catch (...) {
    read.failure = std::current_exception();
  }
  read.progress = source_->progress();
  read.skipped = source_->skipped_lines();
  read.assumptions = source_->assumptions();
  return read;
}

}  // namespace psi_slam
