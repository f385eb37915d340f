// SPDX-License-Identifier: BSD-3-Clause
// Maps logs with few scans: dense logs thinned by odometry, every nth scan of dense logs, and logs that are
// sparse as recorded. Also maps simulated buildings with many sensors, see sensor_sweep.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/run_figures.h"
#include "batch/seeds.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "sparse/node_costs.h"
#include "sparse/sensor_sweep.h"
#include "sparse/sparse_logs.h"
#include "sparse/step_thinned_source.h"

namespace psi_slam {

/// Names of the parts of the benchmark, as the option --parts takes them.
inline constexpr const char* kThinnedPart = "thinned";     ///< dense logs, one scan for each step of odometry
inline constexpr const char* kEveryNthPart = "every-nth";  ///< some dense logs, every 3rd and 5th scan
inline constexpr const char* kSparsePart = "sparse";       ///< sparse logs, all scans
inline constexpr const char* kSimulatedPart = "simulated";  ///< the sweep over simulated sensors

struct SparseOptions {
  std::vector<std::string> parts = {kThinnedPart, kEveryNthPart, kSparsePart, kSimulatedPart};
  SeedRange seeds{1, 3};
  std::vector<std::string> assignments;  ///< "section.key=value": override the settings of every log
  SensorSweepOptions sensors;            ///< sensors.seed is replaced by the first of `seeds`

  bool has(const std::string& part) const;
  bool needs_logs() const { return has(kThinnedPart) || has(kEveryNthPart) || has(kSparsePart); }
};

/// Figures of one run of a log.
struct SparseRow {
  std::string log;
  std::string kept;  ///< scans kept: "1 m / 0.5 rad", "1 of 3", "all"
  std::uint64_t seed = 1;
  /// Errors, relations and scans; times include reading the log. Memory is not measured.
  RunFigures figures;
  std::size_t nodes = 0;
  std::size_t unmatched = 0;  ///< scans after the first that the front end could not match
  std::size_t loops = 0;      ///< accepted loops
  NodeCosts costs;
  /// Mean translation error, in metres, of a thinned log whose kept scans take their poses from the map of
  /// all scans. This part of the error comes from odometry between the kept scans. Empty for other logs.
  std::optional<double> floor_m;
};

/// The map of a sparse log, with the first seed.
struct SparseMapPicture {
  std::string log;
  std::string png;  ///< bytes of the PNG file
};

struct SparseBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<SparseRow> rows;                 ///< ordered by part, log, case and seed
  std::vector<SparseMapPicture> pictures;
  std::vector<SensorSweepRow> sensors;
};

/// Settings of a run of a log, with one thread. Throws UserError as benchmark_settings().
Settings sparse_settings(const BenchmarkLog& log, const SparseOptions& options, std::uint64_t seed,
                         std::size_t every_nth = 1);

/// Maps a dense log thinned to `step`. Composes poses for the removed scans from odometry, and measures the
/// errors of all poses. Throws UserError for a log without odometry.
SparseRow run_thinned(const BenchmarkLog& log, const Settings& settings, const ThinningStep& step);

/// Returns SparseRow::floor_m: the mean translation error, in metres, if the kept scans of the thinned log
/// take their poses from the map of all scans.
double thinned_floor_m(const BenchmarkLog& log, const Settings& settings, const ThinningStep& step);

/// Runs the parts that `options` names. Throws UserError as open_log() and read_relations(), and if these
/// parts have nothing to run.
SparseBenchmark run_sparse_benchmark(const SparseLogs& logs, const SparseOptions& options,
                                     const ProgressObserver& observer);

/// The report of the `sparse` command. In JSON, "rows" has the statistics over the seeds of each case, and
/// "sensors" has a row for each simulated run. The plots are the maps as PNG files, and the error over the
/// step between scans for each maximum range.
BenchReport sparse_report(const SparseBenchmark& benchmark, const SparseOptions& options,
                          const std::string& machine);

}  // namespace psi_slam
