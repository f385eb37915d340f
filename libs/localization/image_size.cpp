// SPDX-License-Identifier: BSD-3-Clause
#include "localization/image_size.h"

#include <zlib.h>

#include "base/byte_cursor.h"

namespace psi_slam {
namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Reads the next whole number of the header of a PNM file, after blanks and comments.
std::uint64_t pnm_number(ByteCursor& cursor) {
  constexpr std::uint64_t kMost = 1'000'000'000;
  char c = cursor.number<char>();
  while (is_space(c) || c == '#') {
    if (c == '#')
      while (c != '\n') c = cursor.number<char>();
    c = cursor.number<char>();
  }
  std::uint64_t number = 0;
  if (c < '0' || c > '9') throw MalformedBytes("expected a number");
  for (; c >= '0' && c <= '9' && number <= kMost; c = cursor.number<char>())
    number = 10 * number + static_cast<std::uint64_t>(c - '0');
  return number;
}

ImageSize pnm_size(std::string_view bytes) {
  ByteCursor cursor(bytes.substr(2));
  const std::uint64_t width = pnm_number(cursor);
  return {width, pnm_number(cursor)};
}

/// Counts the numbers of a PNM file in plain text, each with a blank after it. In a PBM file, each digit is a
/// number. Throws MalformedBytes for other characters.
std::uint64_t pnm_numbers(std::string_view text, bool one_digit) {
  std::uint64_t count = 0;
  bool in_number = false;
  bool in_comment = false;
  for (const char c : text) {
    const bool is_digit = c >= '0' && c <= '9';
    if (c == '#') in_comment = true;
    if (!in_comment && !is_digit && !is_space(c)) throw MalformedBytes("expected a number");
    if (in_number && (one_digit || !is_digit)) ++count;
    in_number = is_digit && !in_comment;
    if (c == '\n') in_comment = false;
  }
  return count + (in_number && one_digit ? 1 : 0);
}

bool pnm_holds_all(std::string_view bytes) {
  constexpr std::uint64_t kMostLevel = 65535;
  const char kind = bytes.at(1);
  const bool is_bits = kind == '1' || kind == '4';
  ByteCursor cursor(bytes.substr(2));
  const std::uint64_t width = pnm_number(cursor);
  const std::uint64_t height = pnm_number(cursor);
  const std::uint64_t level = is_bits ? 1 : pnm_number(cursor);
  if (level == 0 || level > kMostLevel) return false;
  const std::string_view rest = cursor.take(cursor.left());
  const std::uint64_t samples = kind == '3' || kind == '6' ? 3 : 1;
  if (kind < '4') return pnm_numbers(rest, is_bits) >= width * height * samples;
  const std::uint64_t row_bytes = is_bits ? (width + 7) / 8 : width * samples * (level > 255 ? 2 : 1);
  return rest.size() >= row_bytes * height;
}

bool png_holds_all(std::string_view bytes) {
  ByteCursor cursor(bytes, ByteOrder::kBigEndian);
  cursor.take(8);
  while (true) {
    const auto length = cursor.number<std::uint32_t>();
    const std::string_view part = cursor.take(std::size_t{4} + length);
    const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(part.data()), part.size());
    if (cursor.number<std::uint32_t>() != checksum) return false;
    if (part.substr(0, 4) == "IEND") return true;
  }
}

ImageSize png_size(std::string_view bytes) {
  ByteCursor cursor(bytes, ByteOrder::kBigEndian);
  if (cursor.take(16).substr(12) != "IHDR") throw MalformedBytes("expected the header of the image");
  const auto width = cursor.number<std::uint32_t>();
  return {width, cursor.number<std::uint32_t>()};
}

ImageSize bmp_size(std::string_view bytes) {
  ByteCursor cursor(bytes);
  cursor.take(18);
  const auto magnitude = [&] {
    const std::int64_t number = cursor.number<std::int32_t>();
    return static_cast<std::uint64_t>(number < 0 ? -number : number);  // rows from the top: negative height
  };
  const std::uint64_t width = magnitude();
  return {width, magnitude()};
}

/// Goes through the segments up to the one that begins the frame.
ImageSize jpeg_size(std::string_view bytes) {
  ByteCursor cursor(bytes, ByteOrder::kBigEndian);
  cursor.take(2);
  while (true) {
    auto marker = cursor.number<std::uint8_t>();
    while (marker == 0xFF) marker = cursor.number<std::uint8_t>();
    const bool has_size =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    const auto length = cursor.number<std::uint16_t>();
    if (length < 2) throw MalformedBytes("expected a segment");
    if (!has_size) {
      cursor.take(length - 2U);
      continue;
    }
    cursor.take(1);  // bits per sample
    const auto height = cursor.number<std::uint16_t>();
    return {cursor.number<std::uint16_t>(), height};
  }
}

}  // namespace

std::optional<ImageSize> image_size(std::string_view bytes) {
  try {
    if (bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n") return png_size(bytes);
    if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return pnm_size(bytes);
    if (bytes.substr(0, 2) == "BM") return bmp_size(bytes);
    if (bytes.substr(0, 3) == "\xFF\xD8\xFF") return jpeg_size(bytes);
  } catch (const MalformedBytes&) {  // the bytes end before the size
  }
  return std::nullopt;
}

std::optional<double> white_sample(std::string_view bytes) {
  constexpr std::uint64_t kMostOfByte = 255;
  const char kind = bytes.size() > 2 && bytes[0] == 'P' ? bytes[1] : '0';
  if (kind != '2' && kind != '3' && kind != '5' && kind != '6') return std::nullopt;
  ByteCursor cursor(bytes.substr(2));
  for (int i = 0; i < 2; ++i) pnm_number(cursor);  // width and height
  const std::uint64_t white = pnm_number(cursor);
  const bool is_scaled = kind < '4' && white <= kMostOfByte;
  return is_scaled ? std::nullopt : std::optional(static_cast<double>(white));
}

bool holds_all_pixels(std::string_view bytes) {
  try {
    if (bytes.substr(0, 1) == "P") return pnm_holds_all(bytes);
    if (bytes.substr(0, 1) == "\x89") return png_holds_all(bytes);
  } catch (const MalformedBytes&) {  // the bytes end too early
    return false;
  }
  return true;
}

}  // namespace psi_slam
