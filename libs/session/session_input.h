// SPDX-License-Identifier: BSD-3-Clause
// Input of a session: a log, a recording, or a recording and the log that continues it. It can be opened
// several times.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"
#include "session/log_calibration.h"
#include "session/session_recording.h"

namespace psi_slam {

struct Settings;

/// Returns the size of a file on disk in bytes; 0 if it is no regular file.
std::uintmax_t bytes_on_disk(const std::filesystem::path& path);

class SessionInput {
 public:
  /// Opens a stream of frames.
  using OpenStream = std::function<std::unique_ptr<FrameSource>(const LogOptions&)>;

  /// Reads a log from its beginning.
  explicit SessionInput(std::filesystem::path log);

  /// Reads a stream that `open` opens when it is first read. Such an input can be opened once. `name` stands
  /// for the log in reports.
  SessionInput(const std::string& name, OpenStream open);

  /// Reads a recording, and then `log` unless that path is empty. If the checksum of `log` is that of the
  /// recording's last log, only the rest of that log is read, else all of `log`. Throws UserError if `log` is
  /// unreadable or is an earlier log of the recording.
  explicit SessionInput(std::shared_ptr<const SessionRecording> recording, std::filesystem::path log = {});

  /// Reads a recording and then a stream. The stream is opened at once, and read after the recording.
  SessionInput(std::shared_ptr<const SessionRecording> recording, const std::string& name, OpenStream open);

  /// Returns the session in a file, or a log if the file is no session. Throws the errors of
  /// read_session_file().
  static SessionInput of_file(const std::filesystem::path& path);

  /// Returns this input with `edits` instead of its own edits.
  SessionInput with_edits(EditJournal edits) const;

  /// Finds wrong statements of the log about its laser, and estimates the options that log.calibrate leaves
  /// open, unless that was done or the recording has the estimates. open_input() does this too, but each time
  /// and without progress. A log that continues the recording keeps the estimates of the log before it, but
  /// not its mount if it has several lasers. Throws UserError if the log is unreadable, or if its lasers do
  /// not have the names of the estimates.
  void calibrate(const LogOptions& options, const ShareObserver& progress = {});

  /// Returns a source of all frames, recorded frames first, numbered from 0. Throws UserError if the log is
  /// unreadable, if it became shorter since this input was made, or if it continues the recording but begins
  /// before the recording's end.
  std::unique_ptr<FrameSource> open(const LogOptions& options) const;

  /// Whether a stream is read.
  bool is_stream() const { return open_stream_ != nullptr; }
  /// The recording; null if there is none.
  const std::shared_ptr<const SessionRecording>& recording() const { return recording_; }
  /// Path of the log that is read; empty if there is none.
  const std::filesystem::path& log() const { return log_; }
  /// Size of the log on disk when this input was made, in bytes; 0 for a folder or without a log.
  std::uintmax_t log_bytes() const { return log_bytes_; }
  /// All logs, in the order of their frames. The checksum of the last log is empty until it is computed.
  const std::vector<RecordedLog>& logs() const { return logs_; }
  /// The edits, each with the time at which it is made.
  const EditJournal& edits() const { return edits_; }

 private:
  void check_kept_calibration(const LogOptions& options);
  void require_unshortened() const;

  std::shared_ptr<const SessionRecording> recording_;
  OpenStream open_stream_;  ///< empty unless a stream is read
  std::filesystem::path log_;
  std::uintmax_t log_bytes_ = 0;
  std::vector<RecordedLog> logs_;
  EditJournal edits_;
  bool same_log_ = false;           ///< log_ is the last log of the recording
  bool is_examined_ = false;        ///< calibrate() was called
  bool keeps_calibration_ = false;  ///< the calibration of log_ is that of the log before it
};

/// An input that is open for a run.
struct OpenedInput {
  std::unique_ptr<FrameSource> frames;
  std::optional<LogCalibration> calibration;  ///< of the last log; see RecordedLog::calibration
};

/// Opens the input for a run, after log.calibrate. An extra thread reads ahead if a stream is read or if
/// run.threads allows several threads. Throws UserError if settings contradict each other or if the input is
/// unreadable.
OpenedInput open_input(const SessionInput& input, const Settings& settings);

/// Returns the names of the logs: "first.log + second.log".
std::string names_of(const std::vector<RecordedLog>& logs);

}  // namespace psi_slam
