// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of all matching: for a block of width x height neighbouring shifts of a scan, the sum of the
// scores under all its points. The widest instruction set of the machine is chosen at run time; sums are of
// whole numbers, so every choice gives the same result.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psi_slam {

/// sums[y * sums_row + x] += sum over p < points of cells[offsets[p] + y * row_bytes + x],
/// for 0 <= x < width rounded up to kSumLanes and 0 <= y < height: `sums_row` is at least that rounded width,
/// and all the cells so reached must be readable.
using SumKernel = void (*)(const std::uint8_t* cells, std::ptrdiff_t row_bytes, const std::int32_t* offsets,
                           std::size_t points, int width, int height, std::uint32_t* sums,
                           std::ptrdiff_t sums_row);

inline constexpr int kSumLanes = 16;

/// The fastest kernel this machine can run.
SumKernel sum_kernel();

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// The kernel for one instruction set, null where the machine or the build has none: for tests and
/// benchmarks.
SumKernel sum_kernel_for(InstructionSet set);

const char* name(InstructionSet set);

/// The set that sum_kernel() uses.
InstructionSet sum_kernel_instruction_set();

}  // namespace psi_slam
