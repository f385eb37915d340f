// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <string>

namespace psi_slam {

/// "intel, cases   34 %   12:30 left"; without the time before it can be told.
std::string work_progress_text(const std::string& doing, double share, double elapsed_s);

/// One line of a terminal that is written over and over, and gone at the end of its scope. Without a
/// terminal it says nothing.
class WorkProgress {
 public:
  /// `terminal` may be null.
  explicit WorkProgress(std::ostream* terminal) : terminal_(terminal) {}
  ~WorkProgress() { clear(); }
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// `done` of `all` units of the work that the time left is told by; not shown more than a few times a
  /// second.
  void show(const std::string& doing, double done, double all);
  void clear();

 private:
  std::ostream* terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point shown_at_;
};

}  // namespace psi_slam
