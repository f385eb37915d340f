// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace psi_slam {

/// What of a log was left out: lines of a text log that do not parse, of which logs that long-running
/// programs write have a few; odometry of a bag that is no pose. And, which is no fault, scans that no frame
/// took.
struct SkippedLines {
  std::size_t count = 0;
  std::string first;  ///< "path:line: ...", where the first of them is, what it has and what was expected
  std::size_t spare_scans = 0;  ///< of lasers behind the first: see ScanSynchronizer::left_out()

  /// One sentence without its full stop; empty when nothing was left out.
  std::string sentence() const {
    if (count == 0) return {};
    if (count == 1) return "1 message of the log does not parse and is left out: " + first;
    return std::to_string(count) + " messages of the log do not parse and are left out, the first: " + first;
  }

  /// Of a log and of one behind it.
  friend SkippedLines operator+(SkippedLines before, const SkippedLines& behind) {
    if (before.count == 0) before.first = behind.first;
    before.count += behind.count;
    before.spare_scans += behind.spare_scans;
    return before;
  }
};

}  // namespace psi_slam
