// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace psi_slam {

/// Returns whether a line of a YAML file begins with '%', which makes it a directive, or is longer than 64
/// KiB. The library that MRPT parses YAML with never returns from some damaged directives. Files of maps and
/// bags have none. False for a file that is not readable.
inline bool has_yaml_directive(const std::filesystem::path& path) {
  constexpr int kLongestLine = 1 << 16;
  std::ifstream file(path, std::ios::binary);
  bool begins_line = true;
  int length = 0;
  for (char c = 0; file.get(c); begins_line = c == '\n' || c == '\r') {
    if (begins_line) length = 0;
    if ((begins_line && c == '%') || (c != '\n' && c != '\r' && ++length > kLongestLine)) return true;
  }
  return false;
}

}  // namespace psi_slam
