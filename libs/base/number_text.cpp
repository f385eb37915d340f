// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"

#include <array>
#include <charconv>

namespace psi_slam {
namespace {

constexpr std::size_t kLongestDouble = 340;  // the largest double has 309 digits before its point

}  // namespace

std::string fixed_text(double value, int decimals) {
  std::array<char, kLongestDouble> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals).ptr;
  return {text.data(), end};
}

std::string shortest_text(float value) {
  std::array<char, kLongestDouble> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

std::string trimmed_text(double value, int max_decimals) {
  std::string text = fixed_text(value, max_decimals);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace psi_slam
