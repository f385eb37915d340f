// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "logs/frames/own_body.h"
#include "logs/frames/rewindable_source.h"
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
  /// With `most_s`, looks for the body in the first `most_s` seconds only, see find_own_body().
  explicit BodyMaskedSource(std::unique_ptr<FrameSource> source, std::optional<double> most_s = std::nullopt)
      : source_(std::move(source)), most_s_(most_s) {}

  /// Returns the next frame. Delivers all buffered frames, then rethrows the source's error.
  std::optional<Frame> next() override;

  double progress() const override { return source_.progress(); }
  SkippedLines skipped_lines() const override { return source_.skipped_lines(); }

  /// Assumptions of the source, and after the first next() one sentence for each laser that sees the robot.
  std::vector<std::string> assumptions() const override;

 private:
  void look_ahead();

  RewindableSource source_;
  std::optional<double> most_s_;
  bool started_ = false;
  OwnBodyMask mask_;
  std::vector<std::string> sentences_;  ///< what is masked, one sentence for each laser
};

}  // namespace psi_slam
