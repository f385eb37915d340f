// SPDX-License-Identifier: BSD-3-Clause
// Text files with one record per line and words separated by blanks: trajectories, relations, CARMEN logs.
// '#' starts a comment, empty lines are skipped, and errors read "file:line: ...".
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

/// The words of one line that is not empty. The views are valid during the visit only.
struct TextLine {
  const std::filesystem::path& path;
  std::size_t number = 0;  ///< from 1
  std::vector<std::string_view> words;

  /// Returns the error "file:line: complaint".
  UserError error(const std::string& complaint) const;
  /// Returns word `i` as a finite number. Throws UserError naming the word and `what` was expected.
  double finite_number(std::size_t i, const char* what) const;
  /// Returns word `i`, a time stamp in decimal seconds. Throws UserError naming the word.
  TimeUs time(std::size_t i) const;
};

/// Calls `visit` for each line with words, from first to last. Throws UserError if the file cannot be opened,
/// SystemFailure if reading fails later.
void for_each_text_line(const std::filesystem::path& path, const std::function<void(const TextLine&)>& visit);

}  // namespace psi_slam
