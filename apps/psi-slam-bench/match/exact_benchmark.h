// SPDX-License-Identifier: BSD-3-Clause
// Measures the exact search of wide windows against the depth-first search of Hess et al. 2016, on the cases
// of the command `match`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "batch/workers.h"
#include "common/bench_report.h"
#include "common/benchmark_logs.h"
#include "match/loop_cases.h"

namespace psi_slam {

struct ExactBenchmarkOptions {
  std::size_t cases = 100;  ///< number of positive cases from each log, and of negative cases
  std::uint64_t seed = 1;
  std::size_t repeats = 3;  ///< number of times that each search is measured; the least time counts
};

/// Times of a search over the cases, in milliseconds of processor time.
struct SearchTimes {
  double mean_ms = 0;
  double max_ms = 0;
};

/// Cases of one kind, searched with one threshold.
struct ExactBenchmarkRow {
  std::string cases;           ///< "loop" or "no loop"
  double min_response = 0;     ///< threshold of the searches
  std::size_t count = 0;       ///< number of cases
  std::size_t found = 0;       ///< number of cases in which the exact search found a match
  std::size_t equal = 0;       ///< number of cases in which both searches found the same pose, or none
  SearchTimes csm;             ///< exact search, with its tables of bounds and the refinement
  SearchTimes csm_ambiguity;   ///< exact search that also measures the ambiguity
  SearchTimes depth_first;     ///< depth-first search, without its grids of maxima
  double csm_evaluations = 0;  ///< mean number of blocks and poses scored
  double depth_first_evaluations = 0;
};

struct ExactBenchmark {
  std::vector<LogIdentity> logs;
  std::vector<ExactBenchmarkRow> rows;
  double maximum_grids_ms = 0;  ///< mean time of making the depth-first search's grids of a local map
};

/// Maps each log, draws its cases and searches them in this thread. Kinds without any case have no rows.
/// Throws UserError as map_log(), and if there is no case at all.
ExactBenchmark run_exact_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const ExactBenchmarkOptions& options, const ProgressObserver& observer);

/// Searches the cases with one threshold, each `repeats` times, and returns their row. There must be a case.
ExactBenchmarkRow search_exactly(const std::vector<LoopCase>& cases, const CaseOptions& options,
                                 const MapperOptions& mapper, double min_response, std::size_t repeats);

/// The report of the command `exact-search`. JSON and CSV have the rows.
BenchReport exact_report(const ExactBenchmark& benchmark, const ExactBenchmarkOptions& options,
                         const std::string& machine);

}  // namespace psi_slam
