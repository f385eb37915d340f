// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

/// Bytes in memory, compressed without loss at a fast level of zstd.
class PackedBytes {
 public:
  PackedBytes() = default;
  explicit PackedBytes(const std::vector<std::uint8_t>& bytes);

  std::vector<std::uint8_t> unpacked() const;
  std::size_t size() const { return size_; }  ///< size of the unpacked bytes
  std::size_t memory_bytes() const { return packed_.capacity(); }

 private:
  std::size_t size_ = 0;
  std::vector<std::uint8_t> packed_;
};

}  // namespace psi_slam
