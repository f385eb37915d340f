// SPDX-License-Identifier: BSD-3-Clause
// Measures the kernels of the matchers, which are compiled for several instruction sets, against the speed at
// which the processor reads memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/instruction_set.h"
#include "common/bench_report.h"

namespace psi_slam {

struct KernelBenchmarkOptions {
  std::size_t repeats = 20;  ///< number of times that each kernel is measured; the least time counts
};

/// One kernel for one instruction set, called for a scan of 160 points. Sets without a kernel of their own
/// have no row.
struct KernelRow {
  std::string kernel;
  InstructionSet set = InstructionSet::kBaseline;
  double bytes = 0;    ///< bytes that a call reads and writes, each as often as an instruction touches it
  double call_ns = 0;  ///< processor time of a call
  double reading_bytes_per_ns = 0;  ///< limit: see reading_bytes_per_ns(), for memory as large as it works in

  double bytes_per_ns() const { return bytes / call_ns; }
  double share_of_limit() const { return bytes_per_ns() / reading_bytes_per_ns; }
};

struct KernelBenchmark {
  std::vector<KernelRow> rows;  ///< by kernel, then by instruction set
};

/// Scores that the sum kernel adds in a nanosecond when all its lanes are used: for a block of 16 x 8 shifts
/// of a scan on a circle, in a score grid of 0.25 MB, as large as one of Intel.
double sum_kernel_scores_per_ns(std::size_t repeats);

KernelBenchmark run_kernel_benchmark(const KernelBenchmarkOptions& options);

/// The report of the command `kernels`. JSON and CSV have the rows.
BenchReport kernel_report(const KernelBenchmark& benchmark, const KernelBenchmarkOptions& options,
                          const std::string& machine);

}  // namespace psi_slam
