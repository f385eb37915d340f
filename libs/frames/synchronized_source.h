// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <memory>
#include <optional>

#include "psi_slam/frame_source.h"
#include "frames/scan_synchronizer.h"

namespace psi_slam {

/// Makes frames of all lasers out of a source whose frames are the scans of one each (see ScanSynchronizer). What
/// is wrong with the log is told behind the frames before that place.
class SynchronizedSource : public FrameSource {
 public:
  explicit SynchronizedSource(std::unique_ptr<FrameSource> source);

  /// Numbered anew.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override;

 private:
  void read();

  std::unique_ptr<FrameSource> source_;
  ScanSynchronizer synchronizer_;
  std::size_t frames_given_ = 0;
  bool at_end_ = false;
  std::exception_ptr failure_;
};

}  // namespace psi_slam
