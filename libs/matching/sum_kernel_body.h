// SPDX-License-Identifier: BSD-3-Clause
// The body of the sum kernel, with GCC's vector types. It is compiled for the baseline and for AVX2. All
// functions have internal linkage and call no templates of the standard library, because the linker must not
// merge code for different instruction sets.
#pragma once

#include <cstring>

#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

using Cells = std::uint8_t __attribute__((vector_size(kSumLanes)));

// The cells of one or two rows as 16-bit words, each of an even column (low byte) and the odd column after
// it.
using OneRow = std::uint16_t __attribute__((vector_size(kSumLanes)));
using TwoRows = std::uint16_t __attribute__((vector_size(2 * kSumLanes)));
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the even column is the low byte");

// The rows that fill a vector of the instruction set.
#ifdef __AVX2__
using Rows = TwoRows;
#else
using Rows = OneRow;
#endif

// A 16-bit sum holds at most 257 scores of 255.
constexpr std::size_t kPointsPerPass = 257;

inline Cells load(const std::uint8_t* cells) {
  Cells loaded;
  std::memcpy(&loaded, cells, sizeof loaded);
  return loaded;
}

inline void load(const std::uint8_t* cells, std::ptrdiff_t, OneRow& row) {
  row = reinterpret_cast<OneRow>(load(cells));
}

inline void load(const std::uint8_t* cells, std::ptrdiff_t row_bytes, TwoRows& rows) {
  rows = reinterpret_cast<TwoRows>(
      __builtin_shufflevector(load(cells), load(cells + row_bytes), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
                              13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31));
}

// Sums of the cells of one or two rows. Adding whole words and, once more, their high bytes takes fewer
// instructions than widening each byte. Modulo 2^16, `words` is the sum of the even columns plus 256 times
// that of the odd ones.
template <class Words>
struct RowSums {
  static constexpr int kRows = sizeof(Words) / kSumLanes;
  Words words{};
  Words odd{};

  void add(const std::uint8_t* cells, std::ptrdiff_t row_bytes) {
    Words loaded;
    load(cells, row_bytes, loaded);
    words += loaded;
    odd += loaded >> 8;
  }

  void add_to(std::uint32_t* sums, std::ptrdiff_t sums_row) const {
    const Words even = words - (odd << 8);
    for (int y = 0; y < kRows; ++y) {
      for (int i = 0; i < kSumLanes / 2; ++i) {
        sums[y * sums_row + 2 * i] += even[y * kSumLanes / 2 + i];
        sums[y * sums_row + 2 * i + 1] += odd[y * kSumLanes / 2 + i];
      }
    }
  }
};

// Sums a strip of kHeight rows, one vector wide.
template <class Words, int kHeight>
inline void sum_strip(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
                      std::size_t points, std::uint32_t* sums, std::ptrdiff_t sums_row) {
  constexpr int kRows = RowSums<Words>::kRows;
  for (std::size_t first = 0; first < points; first += kPointsPerPass) {
    const std::size_t last = points - first < kPointsPerPass ? points : first + kPointsPerPass;
    RowSums<Words> sum[kHeight / kRows];
    for (std::size_t p = first; p < last; ++p) {
      const std::uint8_t* cell = cells + offsets[p];
      for (int i = 0; i < kHeight / kRows; ++i) sum[i].add(cell + i * kRows * row_bytes, row_bytes);
    }
    for (int i = 0; i < kHeight / kRows; ++i) sum[i].add_to(sums + i * kRows * sums_row, sums_row);
  }
}

void sum_block(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
               std::size_t points, int width, int height, std::uint32_t* sums, std::ptrdiff_t sums_row) {
  for (int x = 0; x < width; x += kSumLanes) {
    int y = 0;
    const auto add = [&](auto strip, int rows) {
      strip(cells + y * row_bytes + x, row_bytes, offsets, points, sums + y * sums_row + x, sums_row);
      y += rows;
    };
    while (y + 8 <= height) add(sum_strip<Rows, 8>, 8);
    while (y + 4 <= height) add(sum_strip<Rows, 4>, 4);
    while (y + 2 <= height) add(sum_strip<Rows, 2>, 2);
    if (y < height) add(sum_strip<OneRow, 1>, 1);
  }
}

}  // namespace
}  // namespace psi_slam
