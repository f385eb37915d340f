// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Hands frames from the program to the session that maps them.
class ScanQueue {
 public:
  void push(Frame frame) {
    {
      const std::lock_guard lock(mutex_);
      frames_.push_back(std::move(frame));
    }
    changed_.notify_all();
  }

  /// No further frame will come.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// Waits for the next frame. Returns nothing after close() and the last frame.
  std::optional<Frame> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !frames_.empty(); });
    if (frames_.empty()) return std::nullopt;
    std::optional<Frame> frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> frames_;
  bool closed_ = false;
};

/// The frames of a queue, numbered by the session.
class QueuedScans : public FrameSource {
 public:
  explicit QueuedScans(std::shared_ptr<ScanQueue> queue) : queue_(std::move(queue)) {}
  std::optional<Frame> next() override { return queue_->pop(); }
  double progress() const override { return 0; }

 private:
  std::shared_ptr<ScanQueue> queue_;
};

}  // namespace psi_slam
