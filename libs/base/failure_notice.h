// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace psi_slam {

/// Returns a message about a file that could not be written and that psi-slam will try to write again later,
/// as a sentence without full stop. `file`: what is written, such as "the journal". `why`: a sentence without
/// full stop.
inline std::string unwritten_text(const std::string& file, const std::string& why) {
  return file + " is not written for now, and psi-slam tries again: " + why;
}

/// Tells once when a file that is written again and again cannot be written, and once when it can be again.
class FailureNotice {
 public:
  /// `file`: what is written, such as "the journal".
  explicit FailureNotice(std::string file) : file_(std::move(file)) {}

  /// `failure`: why the file could not be written the last time, a sentence without full stop; empty if it
  /// was written. Returns a sentence for the user, without full stop, if failures have begun or ended.
  std::optional<std::string> news(const std::optional<std::string>& failure) {
    if (std::exchange(fails_, failure.has_value()) == fails_) return std::nullopt;
    return fails_ ? unwritten_text(file_, *failure) : file_ + " is written again";
  }

 private:
  std::string file_;
  bool fails_ = false;
};

}  // namespace psi_slam
