// SPDX-License-Identifier: BSD-3-Clause
// Compares the matchers over the factor Psi: whole runs with one matcher for all windows, and with the
// matcher that Psi chooses. The scans that searched for loops are divided into strata by their Psi. The
// thresholds of Psi decide well if the best matcher of each stratum is the one that Psi chooses there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "batch/run_figures.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "common/measured_map.h"
#include "psi_slam/matching.h"

namespace psi_slam {

/// Upper bounds of the strata. The first stratum is Psi = 0; the last has no upper bound.
inline constexpr std::array<double, 5> kPsiStrata{0, 0.5, 1, 5, 20};

/// Number of the stratum of a value of Psi, from 0 to kPsiStrata.size(). A bound belongs to the stratum below
/// it, as psi_1 does.
std::size_t psi_stratum(double psi);

/// Name of a stratum: "0", "0 to 0.5", "above 20".
std::string psi_stratum_name(std::size_t stratum);

/// Loop searches of the scans of one stratum, without those of the final search.
struct PsiStratum {
  std::size_t scans = 0;    ///< scans that searched for loops
  std::size_t windows = 0;  ///< windows searched
  std::size_t found = 0;    ///< windows in which a match was found
  std::size_t loops = 0;    ///< loops that became constraints at these scans
  double response_sum = 0;  ///< sum of the responses of all matches found
  /// Time of matching of each scan, in milliseconds, at most the processor time of the whole scan.
  std::vector<double> scan_ms;
  std::array<std::size_t, kSearchKinds.size()> searches{};  ///< `windows` by the search that ran

  PsiStratum& operator+=(const PsiStratum& other);
};
using PsiStrata = std::array<PsiStratum, kPsiStrata.size() + 1>;

/// Divides the searches of a run into strata.
PsiStrata psi_strata(const MeasuredMap& map);

/// Figures of one run.
struct PsiRun {
  std::string log;
  std::string matcher;         ///< value of loop_closure.matcher
  RunFigures figures;          ///< memory is not measured
  std::size_t loops = 0;       ///< accepted loops in the finished graph
  double loop_matching_s = 0;  ///< wall time of all searches, with the final search
  double max_scan_ms = 0;      ///< largest time of matching of a scan, see PsiStratum::scan_ms
  PsiStrata strata;
};

struct PsiBenchmarkOptions {
  std::vector<std::string> matchers = {"csm", "csm_ga", "ga", "adaptive"};
  std::uint64_t seed = 1;
};

struct PsiBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<PsiRun> runs;                    ///< ordered by log, then matcher
};

/// Maps each log with each matcher, with one thread. All `logs` need relations. Throws UserError as
/// open_log() and read_relations().
PsiBenchmark run_psi_benchmark(const std::vector<BenchmarkLog>& logs, const PsiBenchmarkOptions& options,
                               const ProgressObserver& observer);

/// The report of the `psi` command: the strata of each matcher over all logs, and the whole runs. In JSON,
/// "strata" and "runs" have a row for each row of the tables.
BenchReport psi_report(const PsiBenchmark& benchmark, const PsiBenchmarkOptions& options,
                       const std::string& machine);

}  // namespace psi_slam
