// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/html_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/number_text.h"

namespace psi_slam {
namespace {

/// Inserts a comma between thousands.
std::string with_commas(std::string number) {
  const std::size_t first_digit = number[0] == '-' ? 1 : 0;
  for (std::size_t i = std::min(number.find('.'), number.size()); i > first_digit + 3;) {
    i -= 3;
    number.insert(i, ",");
  }
  return number;
}

}  // namespace

std::string escape_html(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr const char* kEntities[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const std::size_t special = kSpecial.find(c);
    if (special != std::string_view::npos) {
      escaped += kEntities[special];
    } else {
      escaped += (byte < 32 && c != '\n' && c != '\t') || byte == 127 ? '?' : c;
    }
  }
  return escaped;
}

std::string base64(std::string_view bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

std::string grouped(std::size_t count) {
  return with_commas(std::to_string(count));
}

std::string grouped(double value, int decimals) {
  return std::isfinite(value) ? with_commas(fixed_text(value, decimals)) : "–";
}

std::string duration_text(double duration_s) {
  if (!std::isfinite(duration_s)) return "–";
  if (duration_s < 100) return fixed_text(duration_s, duration_s < 10 ? 2 : 1) + " s";
  const auto whole = static_cast<std::int64_t>(std::llround(duration_s));
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

std::string milliseconds_text(double milliseconds) {
  const double size = std::abs(milliseconds);
  return grouped(milliseconds, size < 1 ? 3 : size < 10 ? 2 : size < 100 ? 1 : 0);
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return grouped(count) + ' ' + (count == 1 ? one : many);
}

}  // namespace psi_slam
