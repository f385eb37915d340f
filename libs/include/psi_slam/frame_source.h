// SPDX-License-Identifier: BSD-3-Clause
// The one interface over every log format.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "psi_slam/frame.h"
#include "frames/skipped_lines.h"

namespace psi_slam {

/// A log being read from its beginning. Frames come in the order of the file, which is the truth even where
/// the time stamps run backwards. A log is never held in memory as a whole.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, or none at the end. Throws UserError (file, place, what was expected) on a malformed
  /// log; some formats tolerate a few messages that are none, see skipped_lines().
  virtual std::optional<Frame> next() = 0;

  /// How much of the log has been read, in [0, 1], by bytes of the file on disk.
  virtual double progress() const = 0;

  /// What was left out of what has been read so far.
  virtual SkippedLines skipped_lines() const { return {}; }
};

}  // namespace psi_slam
