// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

namespace psi_slam {

/// Error for malformed bytes. Callers that know the file convert it to a UserError that names the file and
/// the position.
class MalformedBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ByteOrder { kLittleEndian, kBigEndian };

/// Reads numbers and byte strings one after the other from bytes in memory. The bytes must outlive the
/// cursor. Throws MalformedBytes if a read would pass the end, for instance because a length in the bytes is
/// wrong.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes, ByteOrder order = ByteOrder::kLittleEndian)
      : bytes_(bytes), order_(order) {}

  std::size_t offset() const { return offset_; }
  std::size_t left() const { return bytes_.size() - offset_; }
  bool at_end() const { return left() == 0; }

  std::string_view take(std::size_t size) {
    if (size > left())
      throw MalformedBytes(std::to_string(size) + " more bytes are expected, but only " +
                           std::to_string(left()) + " are left");
    const std::string_view piece = bytes_.substr(offset_, size);
    offset_ += size;
    return piece;
  }

  std::string_view rest() { return take(left()); }

  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    const std::string_view piece = take(sizeof(Number));
    unsigned char raw[sizeof(Number)];
    std::memcpy(raw, piece.data(), sizeof raw);
    if (order_ != kOrderOfMachine)
      for (std::size_t i = 0; i < sizeof raw / 2; ++i) std::swap(raw[i], raw[sizeof raw - 1 - i]);
    Number value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }

 private:
  static constexpr ByteOrder kOrderOfMachine =
      __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ByteOrder::kLittleEndian : ByteOrder::kBigEndian;

  std::string_view bytes_;
  ByteOrder order_;
  std::size_t offset_ = 0;
};

}  // namespace psi_slam
