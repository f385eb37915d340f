// SPDX-License-Identifier: BSD-3-Clause
// What psi-slam makes of logs that are worse than they were recorded: fewer scans, a narrower laser, noisier
// odometry or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "common/log_identity.h"
#include "batch/seed_range.h"
#include "robustness/degraded_source.h"

namespace psi_slam {

/// One way to make a log worse.
struct RobustnessCase {
  std::string series;  ///< the curve it belongs to: "odometry noise", ...
  std::string name;    ///< its place there: "x 2"
  DegradationOptions degradation;
};

/// True when the case draws random numbers, so that another seed makes another log.
bool draws_random_numbers(const RobustnessCase& degraded);

/// Each series begins with the log as it is. The odometry noise is of scale 1 until the log is known.
std::vector<RobustnessCase> robustness_cases(std::uint64_t seed);

struct RobustnessRow {
  std::string log;
  RobustnessCase degraded;
  std::uint64_t seed = 1;          ///< of the noise
  double translation_error_m = 0;  ///< means over the true relations
  double rotation_error_deg = 0;
  std::size_t relations = 0;  ///< that could be answered: those in gaps too long are not
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans that the front end could not match, without the first
  std::size_t loops = 0;      ///< accepted
  std::optional<double> loop_precision;
  std::optional<double> loop_recall;
};

struct RobustnessLog {
  std::string name;
  OdometryNoise natural;  ///< of its odometry, against the map of the log as it is
};

struct RobustnessBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs of the folder that cannot be evaluated
  std::vector<RobustnessLog> logs;
  std::vector<RobustnessRow> rows;  ///< by log, then case, then seed
};

/// Is told what is being done, and how much of all the work is done.
using RobustnessObserver = std::function<void(const std::string& doing, double done, double all)>;

/// Maps each log once for each case that differs, and once for each seed where the case draws random numbers.
/// Throws UserError as open_log() and read_relations() do.
RobustnessBenchmark run_robustness_benchmark(const std::vector<BenchmarkLog>& logs, const SeedRange& seeds,
                                             const RobustnessObserver& observer);

}  // namespace psi_slam
