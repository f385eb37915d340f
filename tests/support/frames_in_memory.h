// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Yields frames from memory.
class FramesInMemory : public FrameSource {
 public:
  explicit FramesInMemory(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  std::optional<Frame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }
  double progress() const override { return 0; }

 private:
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

}  // namespace psi_slam
