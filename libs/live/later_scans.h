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

/// The scans of a source from the first one on that is later than a recording. The recorded log may be sent
/// again from its beginning, so the scans before are skipped; a notice says so.
class LaterScans : public FrameSource {
 public:
  /// `recorded_to_us`: time of the last recorded scan.
  LaterScans(std::unique_ptr<FrameSource> source, TimeUs recorded_to_us, LiveControl control)
      : source_(std::move(source)), recorded_to_us_(recorded_to_us), control_(std::move(control)) {}

  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (begun_) return frame;
    if (frame && frame->time_us <= recorded_to_us_)
      control_.notify("skipping scans up to " + format_seconds(recorded_to_us_) +
                      " s, the time of the last recorded scan");
    while (frame && frame->time_us <= recorded_to_us_) frame = source_->next();
    begun_ = true;
    return frame;
  }
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  std::unique_ptr<FrameSource> source_;
  TimeUs recorded_to_us_;
  LiveControl control_;
  bool begun_ = false;  ///< a later scan has come
};

}  // namespace psi_slam
