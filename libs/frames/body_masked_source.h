// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frames/own_body.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Replaces readings of the robot's own body in the scans of another source by NaN; see own_body.h. Frames
/// keep their order and number. Scans without such readings stay unchanged.
///
/// The first call of next() reads ahead until the body is known: until OwnBodyFinder::settled(), at most
/// OwnBodyFinder::kMostFrames frames, which wait in memory. The mask therefore applies from the first scan,
/// the log is read once, and the number of threads does not change the mask. A part of the body that
/// appears later is not found.
class BodyMaskedSource : public FrameSource {
 public:
  explicit BodyMaskedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  /// Returns the next frame. Throws an error of the source after the frames before it.
  std::optional<Frame> next() override;

  /// Progress and skipped parts up to the frame that next() returned, without the frames read ahead.
  double progress() const override { return ahead_.empty() ? source_->progress() : progress_; }
  SkippedLines skipped_lines() const override { return ahead_.empty() ? source_->skipped_lines() : skipped_; }

  /// Assumptions of the source, and after the first next() one sentence for each laser that sees the robot.
  std::vector<std::string> assumptions() const override;

 private:
  /// A frame, and the state of the source after reading it.
  struct Read {
    Frame frame;
    double progress = 0;
    SkippedLines skipped;
  };

  void look_ahead();
  std::optional<Frame> next_unmasked();

  std::unique_ptr<FrameSource> source_;
  bool started_ = false;
  bool at_end_ = false;
  std::deque<Read> ahead_;
  std::exception_ptr failure_;  ///< error of reading ahead; thrown after the last frame before the error
  double progress_ = 0;
  SkippedLines skipped_;
  OwnBodyMask mask_;
  std::vector<std::string> sentences_;  ///< what is masked, one sentence for each laser
};

}  // namespace psi_slam
