// SPDX-License-Identifier: BSD-3-Clause
// Helpers for texts: beginnings, trimming and lists of names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

inline bool starts_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

/// The text without the characters of `space` at both ends.
inline std::string_view trimmed(std::string_view text, std::string_view space = " \t") {
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

/// Joins names with commas, for a message: "a, b".
inline std::string name_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace psi_slam
