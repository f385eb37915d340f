// SPDX-License-Identifier: BSD-3-Clause
// Reads a log in a thread of its own, a bounded number of frames ahead of the consumer. Frames and errors
// arrive in the same order as without the thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

class ReadAhead : public FrameSource {
 public:
  /// Holds up to `capacity` frames, at least 1.
  explicit ReadAhead(std::unique_ptr<FrameSource> source, std::size_t capacity = 256);
  ~ReadAhead() override;

  /// Returns the next frame. Delivers all buffered frames, then rethrows the source's error.
  std::optional<Frame> next() override;

  bool is_ready() const override;

  /// Progress of the frames that next() has returned, not of the frames read ahead.
  double progress() const override { return progress_; }
  SkippedLines skipped_lines() const override { return skipped_; }
  std::vector<std::string> assumptions() const override { return assumptions_; }

 private:
  struct Read {
    std::optional<Frame> frame;  ///< empty at the end of the log
    double progress = 0;
    SkippedLines skipped;
    std::vector<std::string> assumptions;
    std::exception_ptr failure;
  };

  void read_all();
  Read read_one();
  Read take();

  std::unique_ptr<FrameSource> source_;
  const std::size_t capacity_;
  double progress_ = 0;
  SkippedLines skipped_;
  std::vector<std::string> assumptions_;

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::deque<Read> ahead_;
  std::exception_ptr failure_;  ///< failure of the thread itself, such as a lack of memory
  bool stop_ = false;

  std::thread thread_;  ///< not started if the system provides no further thread
};

}  // namespace psi_slam
