// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Keeps all frames of another source until rewind(), then yields them again, followed by the rest of the
/// source. A log whose beginning is studied first is thus read only once.
class RewindableSource : public FrameSource {
 public:
  explicit RewindableSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<Frame> next() override {
    if (rewound_ && !kept_.empty()) {
      Kept first = std::move(kept_.front());
      kept_.pop_front();
      progress_ = first.progress;
      skipped_ = std::move(first.skipped);
      return std::move(first.frame);
    }
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    if (rewound_) {
      std::optional<Frame> frame = source_->next();
      progress_ = source_->progress();
      return frame;
    }
    return read_and_keep();
  }

  /// The next frame is the first of the log. Call at most once.
  void rewind() {
    rewound_ = true;
    progress_ = 0;
  }

  double progress() const override { return progress_; }
  /// Skipped parts up to the frame that next() returned.
  SkippedLines skipped_lines() const override {
    return rewound_ && !kept_.empty() ? skipped_ : source_->skipped_lines();
  }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  struct Kept {
    Frame frame;
    double progress = 0;  // after the frame
    SkippedLines skipped;
  };

  std::optional<Frame> read_and_keep() {
    try {
      std::optional<Frame> frame = source_->next();
      progress_ = source_->progress();
      if (frame) kept_.push_back({*frame, progress_, source_->skipped_lines()});
      return frame;
    } catch (const UserError&) {
      failure_ = std::current_exception();  // thrown again after the kept frames
      throw;
    }
  }

  std::unique_ptr<FrameSource> source_;
  std::deque<Kept> kept_;
  std::exception_ptr failure_;
  bool rewound_ = false;
  double progress_ = 0;
  SkippedLines skipped_;
};

}  // namespace psi_slam
