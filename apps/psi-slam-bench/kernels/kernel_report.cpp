// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"
#include "batch/kept_run.h"
#include "kernels/kernel_benchmark.h"

namespace psi_slam {
namespace {

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::kBaseline:
      return "baseline";
    case InstructionSet::kAvx2:
      return "AVX2";
    case InstructionSet::kAvx512:
      return "AVX-512";
  }
  return "";
}

ReportTable rows_table(const std::vector<KernelRow>& rows) {
  return table_of<KernelRow>(
      {column("kernel", "kernel", &KernelRow::kernel),
       {{"instructions", "instructions"}, [](const KernelRow& row) { return cell(name_of(row.set)); }},
       column("bytes", "bytes", &KernelRow::bytes, 0),
       column("time [ns]", "time_ns", &KernelRow::call_ns, 0),
       {{"bytes / ns", "bytes_per_ns"}, [](const KernelRow& row) { return cell(row.bytes_per_ns(), 1); }},
       column("limit [bytes / ns]", "reading_bytes_per_ns", &KernelRow::reading_bytes_per_ns, 0),
       {{"share of the limit", "share_of_limit"},
        [](const KernelRow& row) {
          return ReportCell{fixed_text(100 * row.share_of_limit(), 0) + " %", row.share_of_limit()};
        }}},
      rows);
}

}  // namespace

BenchReport kernel_report(const KernelBenchmark& benchmark, const KernelBenchmarkOptions& options,
                          const std::string& machine) {
  const ReportTable rows = rows_table(benchmark.rows);
  const std::string text =
      "# Kernels of the matchers\n\n" + measured_by(machine) +
      ", one thread. Times are the processor times of a call for a scan of 160 points in a score grid of "
      "0.25 MB, least of " +
      std::to_string(options.repeats) +
      " measurements.\n\n"
      "- bytes: what a call reads and writes, each byte as often as an instruction touches it\n"
      "- limit: the speed at which the widest vectors of the machine read memory in order, again and again: "
      "0.25 MB for the kernels that read the grid, and 4 kB, which stay in the first cache, for the "
      "others\n\n";
  return {"kernels.md",
          text + rows.markdown(),
          json_file_text(report_json("psi-slam-kernels", machine,
                                     {{"repeats", options.repeats}, {"rows", rows.json()}})),
          rows.csv(),
          {}};
}

}  // namespace psi_slam
