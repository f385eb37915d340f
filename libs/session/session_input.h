// SPDX-License-Identifier: BSD-3-Clause
// Input of a session: a log, a recording, or a recording and the log that continues it. It can be opened
// several times.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"
#include "session/session_recording.h"

namespace psi_slam {

struct Settings;

class SessionInput {
 public:
  /// A log from its beginning.
  explicit SessionInput(std::filesystem::path log);

  /// A recording, continued by `log` unless it is empty. If the checksum of `log` is that of the recording's
  /// last log, the rest of that log is read, else all of `log`. Throws UserError if `log` is unreadable or is
  /// an earlier log of the recording.
  explicit SessionInput(std::shared_ptr<const SessionRecording> recording, std::filesystem::path log = {});

  /// The session in a file, or the log if the file is no session.
  static SessionInput of_file(const std::filesystem::path& path);

  /// This input with `edits` instead of its own.
  SessionInput with_edits(EditJournal edits) const;

  /// All frames, recorded and read, numbered from 0. Throws UserError if the log is unreadable, or if it
  /// continues the recording but begins before the recording's end.
  std::unique_ptr<FrameSource> open(const LogOptions& options) const;

  /// Null if there is no recording.
  const std::shared_ptr<const SessionRecording>& recording() const { return recording_; }
  /// Path of the log that is read; empty if there is none.
  const std::filesystem::path& log() const { return log_; }
  /// All logs. The checksum of the last one is empty until it is needed.
  const std::vector<RecordedLog>& logs() const { return logs_; }
  /// Edits, each made at its time.
  const EditJournal& edits() const { return edits_; }

 private:
  std::shared_ptr<const SessionRecording> recording_;
  std::filesystem::path log_;
  std::vector<RecordedLog> logs_;
  EditJournal edits_;
  bool same_log_ = false;  ///< log_ is the last log of the recording
};

/// Opens the input for a run. With several threads, a thread of its own reads ahead. Throws UserError if
/// settings contradict each other or if the input is unreadable.
std::unique_ptr<FrameSource> open_input(const SessionInput& input, const Settings& settings);

/// "first.log + second.log".
std::string names_of(const std::vector<RecordedLog>& logs);

}  // namespace psi_slam
