// SPDX-License-Identifier: BSD-3-Clause
// Recorded frames, followed by those of a log. skipped_lines() is only about the last log, since the
// recording has that of the logs before.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "psi_slam/frame_source.h"
#include "session/session_recording.h"

namespace psi_slam {

/// The recorded frames and the rest of their last log. Without the log, the frames end as they did when they
/// were recorded, at the end of the log or with its damage.
class RecordedSource : public FrameSource {
 public:
  explicit RecordedSource(std::shared_ptr<const SessionRecording> recording)
      : recording_(std::move(recording)) {}
  /// `log` is the last log of the recording, read from its beginning; `path` is its path.
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

/// The recorded frames, followed by all of another log.
class AppendedSource : public FrameSource {
 public:
  /// Throws UserError if the log begins before the recording ends.
  AppendedSource(std::shared_ptr<const SessionRecording> recording, std::unique_ptr<FrameSource> log,
                 const std::filesystem::path& path);

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override { return log_->skipped_lines(); }

 private:
  std::shared_ptr<const SessionRecording> recording_;
  std::unique_ptr<FrameSource> log_;
  std::optional<Frame> first_;  ///< of the log; empty once it was returned
  std::size_t next_ = 0;
};

}  // namespace psi_slam
