// SPDX-License-Identifier: BSD-3-Clause
#include "compression/packed_bytes.h"

#include <zlib.h>

#include <stdexcept>

#include "psi_slam/user_error.h"

namespace psi_slam {

PackedBytes::PackedBytes(const std::vector<std::uint8_t>& bytes) : size_(bytes.size()) {
  std::vector<std::uint8_t> room(compressBound(bytes.size()));
  uLongf used = room.size();
  if (compress2(room.data(), &used, bytes.data(), bytes.size(), Z_BEST_SPEED) != Z_OK)
    throw SystemFailure("cannot compress a part of the map: out of memory");
  packed_.assign(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(used));
}

std::vector<std::uint8_t> PackedBytes::unpacked() const {
  std::vector<std::uint8_t> bytes(size_);
  uLongf got = bytes.size();
  if (size_ == 0) return bytes;
  if (uncompress(bytes.data(), &got, packed_.data(), packed_.size()) != Z_OK || got != size_)
    throw std::logic_error("PackedBytes: the packed bytes are corrupt");
  return bytes;
}

}  // namespace psi_slam
