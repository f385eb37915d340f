// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "logs/frames/repeated_scans.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Hands frames from the program to the session that maps them. Leaves out scans that repeat an earlier one,
/// as the readers of logs do.
class ScanQueue {
 public:
  /// Returns whether the frame is mapped.
  bool push(Frame frame) {
    {
      const std::lock_guard lock(mutex_);
      if (repeated_.repeats(frame)) return false;
      frames_.push_back(std::move(frame));
    }
    changed_.notify_all();
    return true;
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

  /// See FrameSource::assumptions().
  std::vector<std::string> assumptions() {
    const std::lock_guard lock(mutex_);
    const std::string sentence = repeated_.sentence();
    return sentence.empty() ? std::vector<std::string>() : std::vector{sentence};
  }

 private:
  std::mutex mutex_;
  RepeatedScans repeated_;
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
  std::vector<std::string> assumptions() const override { return queue_->assumptions(); }

 private:
  std::shared_ptr<ScanQueue> queue_;
};

}  // namespace psi_slam
