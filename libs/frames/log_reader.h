// SPDX-License-Identifier: BSD-3-Clause
// What the readers of all formats have in common.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// What a reader has found in a log so far, besides the frames.
struct LogContents {
  /// Source of the scans: CARMEN messages, a sensor label or a topic; several separated by commas. Empty in a
  /// CARMEN log before the first scan, and in a rawlog whose label is empty.
  std::string laser;
  bool states_beam_angles = true;
  SkippedLines skipped;
  std::map<std::string, std::size_t> messages;      ///< CARMEN: lines of each kind, ignored ones included
  std::size_t scans_with_two_poses = 0;             ///< CARMEN: scans whose pose differs from their odometry
  std::map<std::string, std::size_t> other_lasers;  ///< rawlog: scans of lasers that are not read, by label
};

/// Reader of one format. Each frame is the scan of one laser, even if several lasers are read:
/// SynchronizedSource combines them.
class LogReader : public FrameSource {
 public:
  std::optional<Frame> next() final {
    auto frame = read_frame();
    if (frame) frame->index = frames_given_++;
    return frame;
  }
  SkippedLines skipped_lines() const override { return contents_.skipped; }
  const LogContents& contents() const { return contents_; }

 protected:
  /// Reads the next frame, without its index.
  virtual std::optional<Frame> read_frame() = 0;

  std::size_t frames_given() const { return frames_given_; }

  LogContents contents_;

 private:
  std::size_t frames_given_ = 0;
};

}  // namespace psi_slam
