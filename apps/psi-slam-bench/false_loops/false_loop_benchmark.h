// SPDX-License-Identifier: BSD-3-Clause
// How many false loops the back end survives: they are added to the finished graph of a log, and the back end
// settles them as after a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "false_loops/false_loops.h"
#include "common/log_identity.h"
#include "batch/seed_range.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct FalseLoopBenchmarkOptions {
  std::vector<double> shares_percent{10, 20, 50, 100, 200, 500};  ///< of the loops that the run accepted
  std::vector<FalseLoopKind> kinds{FalseLoopKind::kScattered, FalseLoopKind::kGroups, FalseLoopKind::kNearby};
  SeedRange seeds;
};

/// A graph with loops known to be true, and how good poses of its nodes are.
struct LoopTrial {
  PoseGraph graph;                            ///< at its optimum, which false loops are told from the true by
  std::vector<mrpt::math::TPose2D> unlooped;  ///< the poses of the nodes before any loop was closed
  double max_chi = 5;                         ///< of MapperOptions
  PoseAdjustmentOptions solver;
  struct Error {
    double translation_m = 0;
    double rotation_deg = 0;
  };
  std::function<Error(const std::vector<mrpt::math::TPose2D>& map_T_node)> error;
};

/// What was made of the false loops.
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
  LoopTrialOutcome undefended;   ///< optimised with all loops on, from the poses before any loop
  LoopTrialOutcome worst_first;  ///< switching off the worst only, from there
  LoopTrialOutcome defended;     ///< as the mapper does it, from there
  LoopTrialOutcome from_map;     ///< as the mapper does it, from the map as it stood
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
  std::vector<std::string> without_relations;  ///< logs of the folder that cannot be evaluated
  std::vector<FalseLoopLog> logs;
  std::vector<FalseLoopRow> rows;  ///< by log, kind, share, seed
};

/// Is told what is being done, and how much of all the work is done.
using FalseLoopObserver = std::function<void(const std::string& doing, double done, double all)>;

/// One share of one kind.
FalseLoopRow run_loop_trial(const LoopTrial& trial, FalseLoopKind kind, double share_percent,
                            std::uint64_t seed);

/// Maps each log once, and tries each share of each kind with each seed. Throws UserError as open_log() and
/// read_relations() do.
FalseLoopBenchmark run_false_loop_benchmark(const std::vector<BenchmarkLog>& logs,
                                            const FalseLoopBenchmarkOptions& options,
                                            const FalseLoopObserver& observer);

}  // namespace psi_slam
