// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "logs/frames/max_range_study.h"
#include "logs/frames/rewindable_source.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Replaces codes for "no return" in the scans of a LogReader by infinity, and sets the maximum range of
/// scans whose log states none; see max_range_study.h. Frames keep their order and number.
class MaxRangeSource : public FrameSource {
 public:
  /// Source of a file. The first call of next() calls `study`, which reads the whole log, because codes may
  /// be rare at its beginning.
  MaxRangeSource(std::unique_ptr<FrameSource> source, std::function<MaxRanges()> study)
      : source_(std::move(source)), study_log_(std::move(study)) {}

  /// Source of a stream. The first call of next() reads ahead for `look_over_s` seconds, see LookOver. Later
  /// scans add to the study, so a code that appears later applies from then on.
  MaxRangeSource(std::unique_ptr<FrameSource> source, double look_over_s)
      : source_(std::move(source)), look_over_s_(look_over_s) {}

  /// Returns the next frame. Delivers all buffered frames, then rethrows the source's error.
  std::optional<Frame> next() override;

  double progress() const override { return source_.progress(); }
  SkippedLines skipped_lines() const override { return source_.skipped_lines(); }

  /// Assumptions of the source, and one sentence for each laser with a code below its stated maximum.
  std::vector<std::string> assumptions() const override;

 private:
  void begin();
  void look_ahead();
  void learn(const LaserScan& scan);

  RewindableSource source_;
  std::function<MaxRanges()> study_log_;  // empty for a stream
  double look_over_s_ = 0;
  bool started_ = false;
  MaxRangeStudy study_;            // of a stream
  std::size_t learned_ahead_ = 0;  // frames that were added to the study and not yet returned
  MaxRanges max_ranges_;
};

}  // namespace psi_slam
