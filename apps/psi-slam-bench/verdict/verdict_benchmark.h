// SPDX-License-Identifier: BSD-3-Clause
// Measures the verdict about maps on maps whose errors and faults are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/seeds.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "map/verdict/map_verdict.h"
#include "verdict/faulty_maps.h"

namespace psi_slam {

/// A map counts as right up to this mean error, and as wrong from kWrongMap_m on.
inline constexpr double kRightMap_m = 0.05;
inline constexpr double kWrongMap_m = 0.25;
/// A suspect is right if it is at most this far from the fault.
inline constexpr double kLocated_m = 2.0;

struct VerdictBenchmarkOptions {
  SeedRange seeds;      ///< of simulated buildings
  SeedRange log_seeds;  ///< of the faults of each log
  double path_m = 80;   ///< length of the shortest paths; the longest are 1.75 times as long
};

struct VerdictRow {
  std::string log;  ///< name of the log; empty for a simulated building
  MapFault fault = MapFault::kNone;
  std::uint64_t seed = 1;
  double error_m = 0;         ///< true mean error of the positions, see mean_error_m()
  double map_distance_m = 0;  ///< FaultyMap::distance_m
  MapState state = MapState::kGood;
  double doubt_m = 0;  ///< MapVerdict::doubt_m()
  std::size_t hot_spots = 0;
  /// Distance from the fault to the suspect of the worst hot spot; empty without a hot spot, without one
  /// place of the fault, and if the suspect of a false loop is no loop.
  std::optional<double> distance_m;
  double judge_ms = 0;  ///< processor time of the verdict
};

/// Judges a map. The processor time is that of this process.
VerdictRow judged(const FaultyMap& map);

/// Judges maps of simulated buildings, nine for each seed, then maps of logs: one of each log, and eight for
/// each seed of the logs. Throws UserError as make_maps_of_log().
std::vector<VerdictRow> run_verdict_benchmark(const std::vector<BenchmarkLog>& logs,
                                              const VerdictBenchmarkOptions& options,
                                              const ProgressObserver& observer);

/// Area under the ROC curve: the probability that a random wrong map has a higher doubt than a random right
/// one. Equal doubts count half. Empty without right or without wrong maps.
std::optional<double> area_under_curve(const std::vector<VerdictRow>& rows);

/// Returns whether a fault with one place made the map worse than a right one, so that it should be found.
bool is_fault_to_locate(const VerdictRow& row);

/// The report of the `verdict` command. JSON has an object for each map in "maps".
BenchReport verdict_report(const std::vector<VerdictRow>& rows, const VerdictBenchmarkOptions& options,
                           const std::string& machine);

}  // namespace psi_slam
