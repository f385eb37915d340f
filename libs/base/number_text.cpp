// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/degrees.h"

namespace psi_slam {
namespace {

// Some doubles in radians cannot be written as a double in degrees. A long double in degrees has 11 more
// bits, which suffice to restore every double in radians.
static_assert(std::numeric_limits<long double>::digits >= std::numeric_limits<double>::digits + 11);

constexpr long double kPi = 3.141592653589793238462643383279502884L;
constexpr int kMaxDecimals = 24;
constexpr int kMaxDigits = std::numeric_limits<long double>::max_digits10;

using Buffer = std::array<char, 400>;  // the largest double has 309 digits before its point

template <class Float>
std::optional<Float> parse_finite(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

template <class... Format>
std::string to_text(Format... format) {
  Buffer buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), format...).ptr;
  return {buffer.data(), end};
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  return to_text(value, std::chars_format::fixed, decimals);
}

std::string shortest_text(float value) {
  return to_text(value, std::chars_format::fixed);
}

std::optional<double> parse_number(std::string_view text) {
  return parse_finite<double>(text);
}

std::string exact_text(double value) {
  const double magnitude = std::abs(value);
  if (magnitude == 0 || (magnitude >= 1e-5 && magnitude < 1e15))
    return to_text(value, std::chars_format::fixed);
  return to_text(value);
}

std::optional<std::uint32_t> parse_whole_number(std::string_view text, std::uint32_t maximum) {
  const std::optional<double> value = parse_number(text);
  const bool is_in_range = value && *value >= 0 && *value <= maximum;
  if (!is_in_range || *value != static_cast<std::uint32_t>(*value)) return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

std::optional<double> parse_degrees(std::string_view text) {
  const std::optional<long double> degrees = parse_finite<long double>(text);
  if (!degrees || !parse_number(text)) return {};
  return radians_from_degrees(*degrees);
}

std::string exact_degrees_text(double radians) {
  if (!std::isfinite(radians)) return exact_text(radians);
  const long double degrees = static_cast<long double>(radians) * 180 / kPi;
  if (std::abs(degrees) < 1e15L) {
    for (int decimals = 0; decimals <= kMaxDecimals; ++decimals) {
      std::string text = to_text(degrees, std::chars_format::fixed, decimals);
      if (parse_degrees(text) == radians) return text;
    }
  }
  return to_text(degrees, std::chars_format::scientific, kMaxDigits);
}

std::string trimmed_text(double value, int max_decimals) {
  std::string text = fixed_text(value, max_decimals);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string minutes_text(double duration_s) {
  const auto whole = static_cast<std::int64_t>(std::llround(duration_s));
  const auto two = [](std::int64_t value) { return (value < 10 ? "0" : "") + std::to_string(value); };
  return (whole < 3600 ? std::to_string(whole / 60)
                       : std::to_string(whole / 3600) + ':' + two(whole / 60 % 60)) +
         ':' + two(whole % 60);
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

}  // namespace psi_slam
