// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of all matching: sums the scores under all points of a scan, for a block of width x height
// neighbouring shifts. It uses the widest instruction set of the machine, chosen at run time. The sums are
// integers, so every instruction set gives the same result.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psi_slam {

/// sums[y * sums_row + x] += sum over p < points of cells[offsets[p] + y * row_bytes + x],
/// for 0 <= x < width rounded up to kSumLanes and 0 <= y < height. `sums_row` is at least that rounded width.
/// All cells that this reaches must be readable.
using SumKernel = void (*)(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
                           std::size_t points, int width, int height, std::uint32_t* sums,
                           std::ptrdiff_t sums_row);

inline constexpr int kSumLanes = 16;

/// The fastest kernel that this machine can run.
SumKernel sum_kernel();

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// The kernel for one instruction set; null if the machine or the build lacks it. For tests and benchmarks.
SumKernel sum_kernel_for(InstructionSet set);

// One translation unit each, compiled with the flags of that set.
SumKernel sum_kernel_baseline();
SumKernel sum_kernel_avx2();
SumKernel sum_kernel_avx512();

}  // namespace psi_slam
