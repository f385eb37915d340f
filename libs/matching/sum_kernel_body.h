// SPDX-License-Identifier: BSD-3-Clause
// The body of the sum kernel, with GCC's vector types. It is compiled once for each instruction set. All
// functions have internal linkage and call no templates of the standard library, because the linker must not
// merge code for different instruction sets.
#pragma once

#include <cstring>

#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

using Bytes16 = std::uint8_t __attribute__((vector_size(16)));
using Sums16 = std::uint16_t __attribute__((vector_size(32)));

// A 16-bit sum holds at most 257 scores of 255.
constexpr std::size_t kPointsPerPass = 257;

inline void add_cells(Sums16& sum, const std::uint8_t* cells) {
  Bytes16 bytes;
  std::memcpy(&bytes, cells, sizeof bytes);
  sum += __builtin_convertvector(bytes, Sums16);
}

inline void flush(const Sums16& sum, std::uint32_t* sums) {
  for (int i = 0; i < kSumLanes; ++i) sums[i] += sum[i];
}

template <int kRows>
inline void sum_strip(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
                      std::size_t points, std::uint32_t* sums, std::ptrdiff_t sums_row) {
  for (std::size_t first = 0; first < points; first += kPointsPerPass) {
    const std::size_t last = points - first < kPointsPerPass ? points : first + kPointsPerPass;
    Sums16 sum[kRows] = {};
    for (std::size_t p = first; p < last; ++p) {
      const std::uint8_t* cell = cells + offsets[p];
      for (int y = 0; y < kRows; ++y) add_cells(sum[y], cell + y * row_bytes);
    }
    for (int y = 0; y < kRows; ++y) flush(sum[y], sums + y * sums_row);
  }
}

void sum_block(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
               std::size_t points, int width, int height, std::uint32_t* sums, std::ptrdiff_t sums_row) {
  for (int x = 0; x < width; x += kSumLanes) {
    int y = 0;
    for (; y + 8 <= height; y += 8)
      sum_strip<8>(cells + y * row_bytes + x, row_bytes, offsets, points, sums + y * sums_row + x, sums_row);
    for (; y + 4 <= height; y += 4)
      sum_strip<4>(cells + y * row_bytes + x, row_bytes, offsets, points, sums + y * sums_row + x, sums_row);
    for (; y + 2 <= height; y += 2)
      sum_strip<2>(cells + y * row_bytes + x, row_bytes, offsets, points, sums + y * sums_row + x, sums_row);
    for (; y < height; ++y)
      sum_strip<1>(cells + y * row_bytes + x, row_bytes, offsets, points, sums + y * sums_row + x, sums_row);
  }
}

}  // namespace
}  // namespace psi_slam
