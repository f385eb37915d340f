// SPDX-License-Identifier: BSD-3-Clause
// Robustness of the back end to false loops: adds false loops to the finished graph of a log and lets the
// back end find them.
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
#include "false_loops/false_loops.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct FalseLoopBenchmarkOptions {
  std::vector<double> shares_percent{10, 20, 50, 100, 200, 500};  ///< in percent of the accepted loops
  std::vector<FalseLoopKind> kinds{FalseLoopKind::kScattered, FalseLoopKind::kGroups, FalseLoopKind::kNearby};
  SeedRange seeds;
};

/// A graph with true loops, and the error of poses of its nodes.
struct LoopTrial {
  PoseGraph graph;                            ///< at its optimum
  std::vector<mrpt::math::TPose2D> unlooped;  ///< poses of the nodes before any loop was closed
  double max_chi = 5;                         ///< as in MapperOptions
  PoseAdjustmentOptions solver;
  struct Error {
    double translation_m = 0;
    double rotation_deg = 0;
  };
  std::function<Error(const std::vector<mrpt::math::TPose2D>& map_T_node)> error;
};

/// Result of one treatment of the false loops.
struct LoopTrialOutcome {
  LoopTrial::Error error;
  std::size_t false_kept = 0;
  std::size_t true_lost = 0;
  double milliseconds = 0;
};

struct FalseLoopRow {
  std::string log;
  FalseLoopKind kind = FalseLoopKind::kScattered;
  double share_percent = 0;
  std::uint64_t seed = 1;  ///< of the false loops
  std::size_t true_loops = 0;
  std::size_t false_loops = 0;
  LoopTrialOutcome undefended;   ///< optimised with all loops, from the poses before any loop
  LoopTrialOutcome worst_first;  ///< the worst loops switched off one by one, from the poses before any loop
  LoopTrialOutcome defended;     ///< the method of the mapper, from the poses before any loop
  LoopTrialOutcome from_map;     ///< the method of the mapper, from the finished map
};

struct FalseLoopLog {
  std::string name;
  std::size_t nodes = 0;
  std::size_t loops = 0;
  LoopTrial::Error map;        ///< without false loops
  LoopTrial::Error front_end;  ///< without any loop
};

struct FalseLoopBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<FalseLoopLog> logs;
  std::vector<FalseLoopRow> rows;  ///< by log, kind, share, seed
};

/// Tries one share of one kind with all treatments.
FalseLoopRow run_loop_trial(const LoopTrial& trial, FalseLoopKind kind, double share_percent,
                            std::uint64_t seed);

/// Maps each log once and tries each share of each kind with each seed. Throws UserError as open_log() and
/// read_relations().
FalseLoopBenchmark run_false_loop_benchmark(const std::vector<BenchmarkLog>& logs,
                                            const FalseLoopBenchmarkOptions& options,
                                            const ProgressObserver& observer);

/// The report of the `false-loops` command. In JSON, each element of "rows" has the statistics over the seeds
/// of each treatment: "undefended", "worst_first", "defended" and "from_map". Each kind of false loops has a
/// plot.
BenchReport false_loop_report(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                              const std::string& machine);

/// Plot of the error over the share of false loops of one kind, as SVG: a line for each log with bars from
/// the least to the greatest error of the seeds, and a thin line without the defence.
std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind);

}  // namespace psi_slam
