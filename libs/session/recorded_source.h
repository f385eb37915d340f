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

class RecordedSource : public FrameSource {
 public:
  /// Only the recorded frames. They end as they did when they were recorded: at the end of the last log or
  /// with its damage.
  explicit RecordedSource(std::shared_ptr<const SessionRecording> recording)
      : recording_(std::move(recording)) {}

  enum class Log {
    kLast,  ///< the last log of the recording, whose rest follows
    kNext,  ///< another log, all of which follows
  };
  /// `log` is at its beginning; `path` is its path. Throws UserError if the next log begins before the
  /// recording ends.
  RecordedSource(std::shared_ptr<const SessionRecording> recording, Log kind,
                 std::unique_ptr<FrameSource> log, std::filesystem::path path);

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override;

 private:
  void skip_recorded();

  std::shared_ptr<const SessionRecording> recording_;
  Log kind_ = Log::kLast;
  std::unique_ptr<FrameSource> log_;  ///< null if there is none
  std::filesystem::path path_;
  std::optional<Frame> first_;  ///< of the next log; empty once it was returned
  std::size_t next_ = 0;
};

}  // namespace psi_slam
