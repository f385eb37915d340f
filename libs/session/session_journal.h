// SPDX-License-Identifier: BSD-3-Clause
// Records a session continuously while it is mapped: a crash or a power failure loses only the scans
// of the last moments.
//
//     SessionJournal journal("my.journal", facts, {}, 0.5);
//     after each scan:  journal.add(frame, facts);
//     journal.remove();  // the session is saved, or its results are written
//
// read_session_file() reads the journal like a session.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/file_tail.h"
#include "session/journal_chunks.h"
#include "session/session_recording.h"

namespace psi_slam {

/// Writes a journal in a thread of its own, so that no function except the constructor waits for the disk.
/// What cannot be written, because the disk is full for example, waits compressed in memory and is tried
/// again every period. So the journal is complete again once the disk can be written.
class SessionJournal {
 public:
  /// Creates the file `path`, whole or not at all, with a first chunk of `frames`; replaces an existing file.
  /// Frames that are added later reach the disk after at most about `period_s` seconds. Throws SystemFailure
  /// if the file cannot be written.
  SessionJournal(std::filesystem::path path, const SessionFacts& facts, const std::vector<Frame>& frames,
                 double period_s);
  /// Writes what is left, trying once, and keeps the file.
  ~SessionJournal();
  SessionJournal(const SessionJournal&) = delete;
  SessionJournal& operator=(const SessionJournal&) = delete;

  /// Adds a frame as the mapper receives it, and the facts as of this frame.
  void add(Frame frame, SessionFacts facts);
  /// Replaces the facts, for instance after an edit of a loop.
  void update(SessionFacts facts);

  /// Ends the journal and deletes its file, unless another file, such as a saved session, has replaced it.
  void remove();

  /// Why the journal could not be written the last time, a sentence without full stop; empty if it was
  /// written. Mapping may go on.
  std::optional<std::string> failure() const;

 private:
  using Clock = std::chrono::steady_clock;

  void work();
  void end();

  const std::filesystem::path path_;
  const std::chrono::duration<double> period_;
  JournalChunks chunks_;
  FileTail tail_;

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::vector<Frame> frames_;          ///< frames that no chunk has yet
  std::optional<SessionFacts> facts_;  ///< facts that no chunk has yet
  std::optional<std::string> failure_;
  bool stop_ = false;  ///< the thread ends or has ended

  std::thread thread_;
};

}  // namespace psi_slam
