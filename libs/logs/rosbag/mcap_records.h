// SPDX-License-Identifier: BSD-3-Clause
// Records of MCAP files (https://mcap.dev/spec). Each is one byte of opcode, eight bytes of length, and the
// content. All numbers are little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace psi_slam::mcap {

/// First and last bytes of a file of version 0.
constexpr std::string_view kMagic = "\x89MCAP0\r\n";

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F
};

/// Returns the bytes of an unsigned number.
template <class Number>
std::string packed(Number number) {
  static_assert(std::is_unsigned_v<Number>);
  std::string bytes;
  for (std::size_t i = 0; i < sizeof number; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
  return bytes;
}

/// Returns a text, or the elements of an array or map, after the number of its bytes.
inline std::string packed_text(std::string_view text) {
  return packed(static_cast<std::uint32_t>(text.size())).append(text);
}

/// Returns a whole record.
inline std::string record(Opcode opcode, std::string_view content) {
  return (packed(std::uint8_t{opcode}) + packed(std::uint64_t{content.size()})).append(content);
}

}  // namespace psi_slam::mcap
