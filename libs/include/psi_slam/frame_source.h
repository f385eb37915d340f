// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Interface to logs of every format.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Parts of a log that the reader skipped: messages that do not parse and odometry without a valid pose. Long
/// logs usually hold a few such messages. Spare scans are counted separately, because they are not errors.
struct SkippedLines {
  std::size_t count = 0;        ///< number of skipped messages
  std::string first;            ///< place and error of the first skipped message: "my.log:12: ..."
  std::size_t spare_scans = 0;  ///< number of scans of companion lasers that joined no frame

  /// Returns a sentence about the skipped messages, without full stop; empty if no message was skipped.
  std::string sentence() const {
    if (count == 0) return {};
    if (count == 1) return "1 message of the log is unusable and skipped: " + first;
    return std::to_string(count) + " messages of the log are unusable and skipped, the first: " + first;
  }

  /// Adds the skipped parts of two logs that are read one after the other.
  friend SkippedLines operator+(SkippedLines first_log, const SkippedLines& second_log) {
    if (first_log.count == 0) first_log.first = second_log.first;
    first_log.count += second_log.count;
    first_log.spare_scans += second_log.spare_scans;
    return first_log;
  }
};

/// Reads a log once, from its beginning. Frames have the order of the log, even where time stamps run
/// backwards. Readers of files never hold the whole log in memory.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Returns the next frame, or nothing at the end of the log. Throws UserError if the log is malformed; the
  /// message names file, place and what was expected. Logs may hold malformed messages, which are skipped:
  /// see skipped_lines().
  virtual std::optional<Frame> next() = 0;

  /// Returns whether next() gives what it has without waiting for a sensor or another thread.
  virtual bool is_ready() const { return true; }

  /// Fraction of the log that has been read, in [0, 1], measured in bytes on disk.
  virtual double progress() const = 0;

  /// Returns what the reader has skipped so far.
  virtual SkippedLines skipped_lines() const { return {}; }

  /// Returns what the reader assumed because the log does not state it, and what it left unused: one sentence
  /// each, without its full stop, that names the option to change it.
  virtual std::vector<std::string> assumptions() const { return {}; }
};

}  // namespace psi_slam
