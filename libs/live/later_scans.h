// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "live/live_control.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// The scans of a source from the first one on that is not of the time of a recording. The recorded log may
/// be sent again from its beginning, so these scans are skipped; a notice says so. A clock that begins again
/// before the recording, as on a robot without a battery for its clock, skips nothing.
class LaterScans : public FrameSource {
 public:
  /// `recorded_from_us`, `recorded_to_us`: times of the first and the last recorded scan.
  LaterScans(std::unique_ptr<FrameSource> source, TimeUs recorded_from_us, TimeUs recorded_to_us,
             LiveControl control)
      : source_(std::move(source)),
        recorded_from_us_(recorded_from_us),
        recorded_to_us_(recorded_to_us),
        control_(std::move(control)) {}

  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (begun_) return frame;
    if (frame && is_recorded(*frame))
      control_.notify("skipping scans up to " + format_seconds(recorded_to_us_) +
                      " s, the time of the last recorded scan");
    while (frame && is_recorded(*frame)) frame = source_->next();
    begun_ = true;
    return frame;
  }
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  bool is_recorded(const Frame& frame) const {
    return frame.time_us >= recorded_from_us_ && frame.time_us <= recorded_to_us_;
  }

  std::unique_ptr<FrameSource> source_;
  TimeUs recorded_from_us_;
  TimeUs recorded_to_us_;
  LiveControl control_;
  bool begun_ = false;  ///< a later scan has come
};

}  // namespace psi_slam
