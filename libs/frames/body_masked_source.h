// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frames/own_body.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Replaces readings of the robot's own body in the scans of another source by NaN; see own_body.h. Frames
/// keep their order and number. Scans without such readings stay unchanged.
///
/// The first call of next() opens the log a second time and finds the body in its head: about 60 turns of 20
/// degrees, usually a tenth of a log. The mask therefore applies from the first scan, no frame waits in
/// memory, and the mask does not depend on which frames are mapped. A part of the body that appears later is
/// not found.
class BodyMaskedSource : public FrameSource {
 public:
  /// `open_again` opens the log of `source` at its beginning; each of its frames is the scan of one laser.
  BodyMaskedSource(std::unique_ptr<FrameSource> source,
                   std::function<std::unique_ptr<FrameSource>()> open_again)
      : source_(std::move(source)), open_again_(std::move(open_again)) {}

  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }

  /// Assumptions of the source, and after the first next() one sentence for each laser that sees the robot.
  std::vector<std::string> assumptions() const override;

 private:
  std::unique_ptr<FrameSource> source_;
  std::function<std::unique_ptr<FrameSource>()> open_again_;
  std::optional<OwnBodyMask> mask_;
  std::vector<std::string> sentences_;  ///< what is masked, one sentence for each laser
};

}  // namespace psi_slam
