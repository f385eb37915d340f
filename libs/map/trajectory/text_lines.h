// SPDX-License-Identifier: BSD-3-Clause
// Text files with one record per line and words separated by blanks: trajectories, relations, CARMEN logs.
// '#' starts a comment, lines without words are skipped, and errors read "file:line: ...".
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// A line of a text file, split into words. The views are valid only during the visit.
struct TextLine {
  const std::filesystem::path& path;
  std::size_t number = 0;  ///< number of the line, from 1
  std::vector<std::string_view> words;

  /// Returns the error "file:line: complaint", to be thrown.
  UserError error(const std::string& complaint) const;
  /// Returns word `i`, counted from 0, as a finite number. Throws UserError that names the word and the
  /// expected value `what`. The line must have a word `i`.
  double finite_number(std::size_t i, const char* what) const;
  /// Returns word `i`, a time stamp in decimal seconds, as microseconds. Throws UserError that names the
  /// word.
  TimeUs time(std::size_t i) const;
};

/// Calls `visit` for each line with words, from first to last. Throws UserError if the file cannot be opened,
/// SystemFailure if reading fails later.
void for_each_text_line(const std::filesystem::path& path, const std::function<void(const TextLine&)>& visit);

}  // namespace psi_slam
