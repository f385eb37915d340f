// SPDX-License-Identifier: BSD-3-Clause
// The bodies of the point kernels, most of them loops that the compiler turns into vector instructions. All
// functions have internal linkage or are always inlined, and none calls the standard library, because the
// linker must not merge code for different instruction sets.
#pragma once

#include "matching/point_kernels.h"

namespace psi_slam {
namespace {

void place_points(const CellPlacement<double>& placement, const float* points, std::size_t count,
                  Cell* cells) {
  // Copies, because a write of a cell could change the parameters as far as the compiler knows.
  const CellPlacement<double> p = placement;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(points[2 * i]);
    const auto y = static_cast<double>(points[2 * i + 1]);
    cells[i].x = floor_to_int(p.x0 + p.cosine * x - p.sine * y);
    cells[i].y = floor_to_int(p.y0 + p.sine * x + p.cosine * y);
  }
}

void find_squares_of_points(const SquareSearch& search, const float* x_cells, const float* y_cells,
                            std::size_t count, std::int32_t* squares) {
  const SquareSearch s = search;
  const CellPlacement<float> middle = s.middle;
  for (std::size_t i = 0; i < count; ++i) {
    const float u = middle.cosine * x_cells[i] - middle.sine * y_cells[i];
    const float v = middle.sine * x_cells[i] + middle.cosine * y_cells[i];
    const float dx = __builtin_fabsf(v) * s.across + __builtin_fabsf(u) * s.along + s.rounding;
    const float dy = __builtin_fabsf(u) * s.across + __builtin_fabsf(v) * s.along + s.rounding;
    const int x = floor_to_int(middle.x0 + u - dx) >> 1;
    const int y = floor_to_int(middle.y0 + v - dy) >> 1;
    const int width = ((floor_to_int(middle.x0 + u + dx) + s.stride - 1) >> 1) - x;
    const int height = ((floor_to_int(middle.y0 + v + dy) + s.stride - 1) >> 1) - y;
    squares[i] =
        s.layout.offset(x, y, (width > height ? width : height) + 1, s.window_columns, s.window_rows);
  }
}

void find_offsets_of_cells(const UnclippedCells& unclipped, const Cell* cells, std::size_t count,
                           std::int32_t* offsets) {
  const UnclippedCells u = unclipped;
  for (std::size_t i = 0; i < count; ++i) {
    const int x = (cells[i].x + u.shift.x) >> u.log_stride;
    const int y = (cells[i].y + u.shift.y) >> u.log_stride;
    const bool is_unclipped = (x >= u.first.x) & (x <= u.last.x) & (y >= u.first.y) & (y <= u.last.y);
    // Unsigned numbers may overflow where the cell is clipped.
    const std::uint32_t offset = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(u.row_bytes) +
                                 static_cast<std::uint32_t>(x);
    offsets[i] = is_unclipped ? static_cast<std::int32_t>(offset) : PointKernels::kClipped;
  }
}

#ifdef __AVX512F__

// Merges keys into sorted blocks of one vector each. Has no branches that are hard to predict. Smaller
// instruction sets lack comparisons of eight such keys, and merge them one by one.
void merge_keys(std::int64_t* keys, std::size_t count, const NeighbourKeys& nearest) {
  using Block = std::int64_t __attribute__((vector_size(NeighbourKeys::kBlock * sizeof(std::int64_t))));
  constexpr Block kSmallest = {INT64_MIN};
  for (std::size_t block = 0; block < nearest.blocks; ++block) {
    Block kept;
    __builtin_memcpy(&kept, nearest.keys + NeighbourKeys::kBlock * block, sizeof kept);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t last = kept[NeighbourKeys::kBlock - 1];
      const Block added = keys[i] - Block{};  // the key in all places
      const Block before = __builtin_shufflevector(kept, kSmallest, 8, 0, 1, 2, 3, 4, 5, 6);
      const Block smaller = kept < added ? kept : added;
      kept = before > smaller ? before : smaller;
      keys[i] = last > keys[i] ? last : keys[i];  // the key that this block drops
    }
    __builtin_memcpy(nearest.keys + NeighbourKeys::kBlock * block, &kept, sizeof kept);
  }
}

#else

void merge_keys(const std::int64_t* keys, std::size_t count, const NeighbourKeys& nearest) {
  std::int64_t* const last = nearest.keys + NeighbourKeys::kBlock * nearest.blocks - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t key = keys[i];
    if (key >= *last) continue;
    std::int64_t* place = last;
    for (; place != nearest.keys && place[-1] > key; --place) *place = place[-1];
    *place = key;
  }
}

#endif

void merge_nearest_points(float x_m, float y_m, const IndexedPoints& points, const NeighbourKeys& nearest) {
  constexpr std::size_t kChunk = 64;
  for (std::size_t begin = 0; begin < points.count; begin += kChunk) {
    const std::size_t count = points.count - begin < kChunk ? points.count - begin : kChunk;
    std::int64_t keys[kChunk];
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = points.x_m[begin + i] - x_m;
      const float dy = points.y_m[begin + i] - y_m;
      keys[i] = neighbour_key(dx * dx + dy * dy, points.index[begin + i]);
    }
    merge_keys(keys, count, nearest);
  }
}

constexpr PointKernels kKernels{&place_points, &find_squares_of_points, &find_offsets_of_cells,
                                &merge_nearest_points};

}  // namespace
}  // namespace psi_slam
