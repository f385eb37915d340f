// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/packed_bytes.h"

#include <zstd.h>

#include <stdexcept>

#include "psi_slam/user_error.h"

namespace psi_slam {

PackedBytes::PackedBytes(const std::vector<std::uint8_t>& bytes) : size_(bytes.size()) {
  constexpr int kLevel = 1;
  std::vector<std::uint8_t> room(ZSTD_compressBound(bytes.size()));
  const std::size_t used = ZSTD_compress(room.data(), room.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(used) != 0)
    throw SystemFailure("cannot compress a part of the map: out of memory. Close other programs");
  packed_.assign(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(used));
}

std::vector<std::uint8_t> PackedBytes::unpacked() const {
  std::vector<std::uint8_t> bytes(size_);
  if (size_ == 0) return bytes;
  if (ZSTD_decompress(bytes.data(), bytes.size(), packed_.data(), packed_.size()) != size_)
    throw std::logic_error("PackedBytes: the packed bytes are corrupt");
  return bytes;
}

}  // namespace psi_slam
