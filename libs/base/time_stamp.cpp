// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/time_stamp.h"

#include <cmath>
#include <cstdio>

#include "base/number_text.h"

namespace psi_slam {
namespace {

constexpr TimeUs kMicrosecondsPerSecond = 1'000'000;
constexpr TimeUs kMaxSeconds = kMostTimeUs / kMicrosecondsPerSecond;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

std::string format_seconds(TimeUs time_us) {
  const bool negative = time_us < 0;
  const auto magnitude =
      negative ? std::uint64_t{0} - static_cast<std::uint64_t>(time_us) : static_cast<std::uint64_t>(time_us);
  char text[32];
  std::snprintf(text, sizeof text, "%s%llu.%06llu", negative ? "-" : "",
                static_cast<unsigned long long>(magnitude / kMicrosecondsPerSecond),
                static_cast<unsigned long long>(magnitude % kMicrosecondsPerSecond));
  return text;
}

std::optional<TimeUs> parse_seconds(std::string_view text) {
  if (text.find_first_of("eE") != std::string_view::npos) {
    const std::optional<double> value = parse_number(text);
    if (!value || !(std::abs(*value) < static_cast<double>(kMaxSeconds))) return std::nullopt;
    return std::llround(*value * 1e6);
  }
  std::size_t i = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative || (!text.empty() && text[0] == '+')) ++i;
  TimeUs whole = 0;
  std::size_t digits = 0;
  for (; i < text.size() && is_digit(text[i]); ++i, ++digits) {
    whole = whole * 10 + (text[i] - '0');
    if (whole >= kMaxSeconds) return std::nullopt;
  }
  TimeUs fraction = 0;
  if (i < text.size() && text[i] == '.') {
    TimeUs scale = kMicrosecondsPerSecond / 10;
    for (++i; i < text.size() && is_digit(text[i]); ++i, ++digits) {
      fraction += (text[i] - '0') * scale;
      if (scale == 0 && text[i - 7] == '.' && text[i] >= '5') ++fraction;  // rounds by the seventh decimal
      scale /= 10;
    }
  }
  if (digits == 0 || i != text.size()) return std::nullopt;
  const TimeUs magnitude = whole * kMicrosecondsPerSecond + fraction;
  return negative ? -magnitude : magnitude;
}

}  // namespace psi_slam
