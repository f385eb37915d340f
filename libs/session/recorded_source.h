// SPDX-License-Identifier: BSD-3-Clause
// Frames that were recorded, and behind them those of a log. What was skipped is told of the last log alone:
// of those before, the recording says it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "psi_slam/frame_source.h"
#include "session/session_recording.h"

namespace psi_slam {

/// The recorded frames and what is left of their last log, if it is given. Without it the log ends, or breaks
/// off, where it did.
class RecordedSource : public FrameSource {
 public:
  explicit RecordedSource(std::shared_ptr<const SessionRecording> recording)
      : recording_(std::move(recording)) {}
  /// `log` is the last of the recording, at its beginning, and `path` its name.
  RecordedSource(std::shared_ptr<const SessionRecording> recording, std::unique_ptr<FrameSource> log,
                 std::filesystem::path path)
      : recording_(std::move(recording)), log_(std::move(log)), path_(std::move(path)) {}

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override;

 private:
  void pass_by_recorded();

  std::shared_ptr<const SessionRecording> recording_;
  std::unique_ptr<FrameSource> log_;
  std::filesystem::path path_;
  std::size_t next_ = 0;
};

/// The recorded frames and then all of another log.
class AppendedSource : public FrameSource {
 public:
  /// Throws UserError when the log begins before the recording ends.
  AppendedSource(std::shared_ptr<const SessionRecording> recording, std::unique_ptr<FrameSource> log,
                 const std::filesystem::path& path);

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override { return log_->skipped_lines(); }

 private:
  std::shared_ptr<const SessionRecording> recording_;
  std::unique_ptr<FrameSource> log_;
  std::optional<Frame> first_;  ///< of the log
  std::size_t next_ = 0;
};

}  // namespace psi_slam
