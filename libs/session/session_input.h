// SPDX-License-Identifier: BSD-3-Clause
// What a session maps: a log, a recording, or a recording and the log that goes on behind it. It can be
// opened as often as one likes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"
#include "session/session_recording.h"

namespace psi_slam {

class SessionInput {
 public:
  /// A log from its beginning.
  explicit SessionInput(std::filesystem::path log);

  /// What was recorded; behind it what `log` holds, if one is named: what is left of the last log of the
  /// recording, or all of one that goes on where that ended. Which of them, its checksum says. Throws
  /// UserError when it cannot be read or was mapped before another.
  explicit SessionInput(std::shared_ptr<const SessionRecording> recording, std::filesystem::path log = {});

  /// What a file that is named holds: a session, or else a log.
  static SessionInput of_file(const std::filesystem::path& path);

  /// The same with these edits instead of the recording's.
  SessionInput with_edits(EditJournal edits) const;

  /// All frames, recorded or not, numbered from 0. Throws UserError when the log cannot be opened, and where
  /// it is to go on behind the recording but begins before its end.
  std::unique_ptr<FrameSource> open(const LogOptions& options) const;

  /// Null where nothing was recorded.
  const std::shared_ptr<const SessionRecording>& recording() const { return recording_; }
  /// The log that is read, with its folder; empty: none.
  const std::filesystem::path& log() const { return log_; }
  /// All logs; the last one's checksum is empty as long as nobody needed it.
  const std::vector<RecordedLog>& logs() const { return logs_; }
  /// That are made on the way, each at its time.
  const EditJournal& edits() const { return edits_; }

 private:
  std::shared_ptr<const SessionRecording> recording_;
  std::filesystem::path log_;
  std::vector<RecordedLog> logs_;
  EditJournal edits_;
  bool same_log_ = false;  ///< the log is the recording's last
};

/// "first.log + second.log".
std::string names_of(const std::vector<RecordedLog>& logs);

}  // namespace psi_slam
