// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of all matching: sums the scores under all points of a scan, for a block of width x height
// neighbouring shifts. The kernel for the widest instruction set of the machine is chosen at run time. The
// sums are integers, so all kernels give the same result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/instruction_set.h"

namespace psi_slam {

/// sums[y * sums_row + x] += sum over p < points of cells[offsets[p] + y * row_bytes + x],
/// for 0 <= y < height and 0 <= x < the next multiple of kSumLanes from `width` on. `sums_row` is at least
/// this multiple. All these cells must be readable.
using SumKernel = void (*)(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
                           std::size_t points, int width, int height, std::uint32_t* sums,
                           std::ptrdiff_t sums_row);

inline constexpr int kSumLanes = 16;

/// Returns the fastest kernel that this machine can use.
SumKernel sum_kernel();

/// Returns the kernel for one instruction set; null if this machine cannot use that set. AVX-512 has that of
/// AVX2, because its own was not faster. For tests.
SumKernel sum_kernel_for(InstructionSet set);

// Each kernel has its own translation unit, compiled with the flags of its instruction set.
SumKernel sum_kernel_baseline();
SumKernel sum_kernel_avx2();

}  // namespace psi_slam
