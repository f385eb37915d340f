// SPDX-License-Identifier: BSD-3-Clause
// Loops over the points of a scan that prepare the sums of their scores, or find those near a place. Each
// kernel is compiled once for each instruction set, and the widest of the machine is chosen at run time. All
// operations are rounded alike in each, and none are fused, so all kernels give the same result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/instruction_set.h"
#include "matching/bound_layout.h"
#include "matching/cell.h"

namespace psi_slam {

/// A rotation and a translation, which place points of the robot's frame in cells of a grid.
template <class Number>
struct CellPlacement {
  Number x0 = 0;  ///< position of the robot in cells
  Number y0 = 0;
  /// Cosine and sine of the heading, multiplied by the number of cells per unit of the points.
  Number cosine = 1;
  Number sine = 0;
};

/// Squares that points cannot leave while they turn and move, see BoundLevel. All lengths are in cells.
struct SquareSearch {
  CellPlacement<float> middle;  ///< in finest cells from the origin of the tables, at the middle heading
  float across = 0;             ///< sine of half the turn
  float along = 0;              ///< 1 - cosine of half the turn
  float rounding = 0;           ///< by which the squares are larger
  int stride = 0;
  int window_columns = 0;  ///< blocks of the window
  int window_rows = 0;
  BoundLayout layout;
};

/// Cells whose sums over a block of shifts need no bounds check.
struct UnclippedCells {
  Cell shift;          ///< added to each cell before it is divided by the stride
  int log_stride = 0;  ///< binary logarithm of the stride
  Cell first;          ///< smallest such cell along each axis
  Cell last;           ///< largest such cell along each axis
  std::int32_t row_bytes = 0;
};

/// Points in arrays, metres, with an index each.
struct IndexedPoints {
  const float* x_m = nullptr;
  const float* y_m = nullptr;
  const std::uint32_t* index = nullptr;
  std::size_t count = 0;
};

/// Returns the key of a neighbour. Keys order neighbours by distance and then by index: they have the bits of
/// the square of the distance, in m^2, above those of the index.
__attribute__((always_inline)) inline std::int64_t neighbour_key(float square_m2, std::uint32_t index) {
  std::int32_t bits = 0;
  __builtin_memcpy(&bits, &square_m2, sizeof bits);
  return (static_cast<std::int64_t>(bits) << 32) | static_cast<std::int64_t>(index);
}

/// Neighbours of a place, as keys.
struct NeighbourKeys {
  static constexpr std::size_t kBlock = 8;
  std::int64_t* keys = nullptr;  ///< `blocks` times kBlock keys, ascending
  std::size_t blocks = 0;
};

/// The kernels for one instruction set.
struct PointKernels {
  /// Offset of a cell that needs a bounds check.
  static constexpr std::int32_t kClipped = INT32_MIN;

  /// Sets cells[i] to the cell of the point (points[2 i], points[2 i + 1]).
  void (*place)(const CellPlacement<double>& placement, const float* points, std::size_t count, Cell* cells);
  /// Sets squares[i] to BoundLayout::offset() of the square of the point (x_cells[i], y_cells[i]).
  void (*find_squares)(const SquareSearch& search, const float* x_cells, const float* y_cells,
                       std::size_t count, std::int32_t* squares);
  /// Sets offsets[i] to the offset of cells[i] from cell (0, 0) in bytes, or to kClipped.
  void (*find_offsets)(const UnclippedCells& unclipped, const Cell* cells, std::size_t count,
                       std::int32_t* offsets);
  /// Computes a key from the distance of each point to (x_m, y_m), inserts the keys into `nearest`, and keeps
  /// only the smallest.
  void (*merge_nearest)(float x_m, float y_m, const IndexedPoints& points, const NeighbourKeys& nearest);
};

/// Returns the fastest kernels that this machine can use.
const PointKernels& point_kernels();

/// Returns the kernels for one instruction set; null if this machine cannot use that set, or the build lacks
/// it. For tests.
const PointKernels* point_kernels_for(InstructionSet set);

// Each set of kernels has its own translation unit, compiled with the flags of its instruction set.
const PointKernels& point_kernels_baseline();
const PointKernels& point_kernels_avx2();
const PointKernels& point_kernels_avx512();

}  // namespace psi_slam
