// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>
#include <string>

#include "psi_slam/mapping_session.h"

namespace psi_slam {

/// " 43 %   5876 scans   2100 scans/s   0:04 left"; of the later phases, what is being done. The time left is
/// that of the phase.
std::string progress_text(const SessionProgress& progress);

/// "0:07", "12:30", "1:02:03".
std::string minutes_text(double seconds);

/// One line of a terminal that is written over and over, and gone at the end of its scope.
class ProgressLine {
 public:
  explicit ProgressLine(std::ostream& terminal) : terminal_(terminal) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows every new phase, and within one not more than a few lines a second.
  void show(const SessionProgress& progress);
  void clear();

 private:
  std::ostream& terminal_;
  std::optional<SessionProgress::Phase> phase_;  // shown now
  std::chrono::steady_clock::time_point shown_at_;
};

}  // namespace psi_slam
