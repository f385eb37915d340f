// SPDX-License-Identifier: BSD-3-Clause
// Progress on a terminal: one line that is overwritten.
#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>
#include <string>

#include "psi_slam/mapping_session.h"

namespace psi_slam {

/// Text such as " 43 %   5876 scans   2100 scans/s   0:04 left". The final loop search has its name in place
/// of the scans; the text of the writing phase has no figures. The time left is that of the current phase.
/// With `of_stream`, the mapping phase has only the scans, because the end of the log is unknown.
std::string progress_text(const SessionProgress& progress, bool of_stream = false);

/// Text such as "intel, cases   34 %   12:30 left", without the time left in the first percent of the work.
std::string work_progress_text(const std::string& doing, double share, double elapsed_s);

/// A line of a terminal that show() overwrites and the destructor erases. Without a terminal nothing is
/// written.
class OverwrittenLine {
 public:
  /// `terminal` may be null.
  explicit OverwrittenLine(std::ostream* terminal) : terminal_(terminal) {}
  ~OverwrittenLine() { clear(); }
  OverwrittenLine(const OverwrittenLine&) = delete;
  OverwrittenLine& operator=(const OverwrittenLine&) = delete;

  /// True if there is a terminal and nothing was shown on the line in the last 0.2 s.
  bool is_due() const;
  void show(const std::string& text);
  void clear();

 private:
  std::ostream* terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point shown_at_;
};

/// Progress of a session. Shows every new phase at once, and updates a phase a few times a second.
class ProgressLine {
 public:
  enum class Input { kLog, kStream };

  explicit ProgressLine(std::ostream& terminal, Input input = Input::kLog)
      : line_(&terminal), input_(input) {}

  void show(const SessionProgress& progress);
  void clear();

 private:
  OverwrittenLine line_;
  Input input_;
  std::optional<SessionProgress::Phase> phase_;  ///< phase shown last
};

/// Progress of any work, updated a few times a second.
class WorkProgress {
 public:
  /// `terminal` may be null.
  explicit WorkProgress(std::ostream* terminal) : line_(terminal) {}

  /// Shows the name `doing` of the work, and the share of it that is finished: `done` of `all` units. Does
  /// nothing if the line was updated in the last 0.2 s.
  void show(const std::string& doing, double done, double all);
  void clear() { line_.clear(); }

 private:
  OverwrittenLine line_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace psi_slam
