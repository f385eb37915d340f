// SPDX-License-Identifier: BSD-3-Clause
// Maps degraded logs: with fewer scans, a narrower field of view, noisier odometry or no odometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/seeds.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "robustness/degraded_source.h"

namespace psi_slam {

/// One way to degrade a log.
struct RobustnessCase {
  std::string series;  ///< curve of the plot: "odometry noise", ...
  std::string name;    ///< place on the curve: "× 2"
  DegradationOptions degradation;
};

/// True if the degraded log depends on the seed.
bool draws_random_numbers(const RobustnessCase& degraded);

/// All cases. Each series starts with the unchanged log. The natural noise is not set: it depends on the log.
std::vector<RobustnessCase> robustness_cases(std::uint64_t seed);

struct RobustnessRow {
  std::string log;
  RobustnessCase degraded;
  std::uint64_t seed = 1;          ///< of the noise
  double translation_error_m = 0;  ///< mean over the true relations
  double rotation_error_deg = 0;   ///< mean over the true relations
  std::size_t relations = 0;       ///< evaluated relations; those in long gaps of the path are not evaluated
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans that the front end could not match, except the first
  std::size_t loops = 0;      ///< accepted
  std::optional<double> loop_precision;
  std::optional<double> loop_recall;
};

struct RobustnessLog {
  std::string name;
  OdometryNoise natural;  ///< noise of its odometry, measured against the map of the unchanged log
};

struct RobustnessBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<RobustnessLog> logs;
  std::vector<RobustnessRow> rows;  ///< by log, then case, then seed
};

/// Maps each log once for each different case, or once for each seed if the case depends on it. Throws
/// UserError as open_log() and read_relations().
RobustnessBenchmark run_robustness_benchmark(const std::vector<BenchmarkLog>& logs, const SeedRange& seeds,
                                             const ProgressObserver& observer);

/// The report of the `robustness` command. In JSON, "logs" has the natural noise of each log's odometry, and
/// "rows" has the statistics over the seeds of each case: {"mean", "std", "min", "max"}. A precision or
/// recall without loops or relations is null. Each series has a plot of the error of each log.
BenchReport robustness_report(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                              const std::string& machine);

}  // namespace psi_slam
