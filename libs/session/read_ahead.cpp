// SPDX-License-Identifier: BSD-3-Clause
#include "session/read_ahead.h"

#include <algorithm>
#include <utility>

namespace psi_slam {

ReadAhead::ReadAhead(std::unique_ptr<FrameSource> source, std::size_t capacity)
    : source_(std::move(source)),
      capacity_(std::max<std::size_t>(capacity, 1)),
      thread_([this] { read_all(); }) {}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<Frame> ReadAhead::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ahead_.empty(); });
  const bool is_last = !ahead_.front().frame.has_value();
  progress_ = ahead_.front().progress;
  skipped_ = ahead_.front().skipped;
  assumptions_ = ahead_.front().assumptions;
  if (is_last) {  // the last entry stays in the queue for further calls
    if (ahead_.front().failure) std::rethrow_exception(ahead_.front().failure);
    return std::nullopt;
  }
  std::optional<Frame> frame = std::move(ahead_.front().frame);
  ahead_.pop_front();
  // The reader waits only if the queue is full, so the queue passes through this size before it is empty.
  const bool wakes_reader = ahead_.size() == capacity_ / 2;
  lock.unlock();
  if (wakes_reader) changed_.notify_all();
  return frame;
}

bool ReadAhead::is_ready() const {
  const std::lock_guard lock(mutex_);
  return !ahead_.empty();
}

void ReadAhead::read_all() {
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
}

ReadAhead::Read ReadAhead::read_one() noexcept {
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
