// SPDX-License-Identifier: BSD-3-Clause
// Texts of the user and of files in messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace psi_slam {

/// Returns a text for a message: at most `most_bytes` of it, then "...", and '?' instead of control
/// characters. A message would end at a NUL byte.
inline std::string quotable(std::string_view text, std::size_t most_bytes = 80) {
  constexpr char kDelete = 0x7f;
  std::size_t size = text.size();
  if (size > most_bytes) {
    size = most_bytes;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;  // within a letter
  }
  std::string quoted(text.substr(0, size));
  for (char& c : quoted)
    if ((static_cast<unsigned char>(c) < ' ' && c != '\t') || c == kDelete) c = '?';
  return size < text.size() ? quoted + "..." : quoted;
}

}  // namespace psi_slam
