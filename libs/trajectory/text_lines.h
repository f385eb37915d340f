// SPDX-License-Identifier: BSD-3-Clause
// Text files of blank-separated words, one record a line, as trajectories, relations and CARMEN logs are: '#'
// starts a comment, empty lines are passed over, and every mistake is reported as "file:line: ...".
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

/// One line that says something; its words live as long as the visit does.
struct TextLine {
  const std::filesystem::path& path;
  std::size_t number = 0;  ///< from 1
  std::vector<std::string_view> words;

  /// "file:line: complaint".
  UserError error(const std::string& complaint) const;
  /// Word `i` as a finite number; throws UserError naming the word and `what` was expected.
  double finite_number(std::size_t i, const char* what) const;
  /// Word `i` as a time stamp in decimal seconds; throws UserError naming the word.
  TimeUs time(std::size_t i) const;
};

/// Visits the lines of a text file in their order. Throws UserError when the file cannot be read.
void for_each_text_line(const std::filesystem::path& path, const std::function<void(const TextLine&)>& visit);

}  // namespace psi_slam
