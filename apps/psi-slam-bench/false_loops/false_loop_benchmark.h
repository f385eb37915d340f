// SPDX-License-Identifier: BSD-3-Clause
// Measures the robustness of the back end to false loops and to slips of the front end. Adds false loops to
// the finished graph of a log, and counts those that the back end rejects; or bends stretches of its
// path.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "batch/seeds.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

enum class FalseLoopKind {
  kScattered,  ///< false loops that are independent of each other
  kGroups,     ///< groups of false loops: successive nodes join one wrong place and agree with each other
  kNearby,     ///< true loops moved by metres, within the uncertainty of odometry
  kSlips,      ///< no false loops, but stretches of the front end's path are bent: see bent_path.h
};

/// Name of a kind: "scattered", "groups", "nearby" or "slips".
std::string name_of(FalseLoopKind kind);

struct FalseLoopOptions {
  FalseLoopKind kind = FalseLoopKind::kScattered;
  std::size_t count = 0;
  std::size_t smallest_group = 5;
  std::size_t largest_group = 10;
  double reach_m = 10;  ///< largest distance of a wrong place from the reference
  /// Nearby loops are moved by min_error_m to nearby_m and rotated by up to min_error_rad.
  double nearby_m = 3;
  /// A loop is false if it differs from the truth by at least this distance or at least this angle.
  double min_error_m = 1;
  double min_error_rad = radians_from_degrees(20.0L);
  std::uint64_t seed = 1;
};

/// Adds `count` false loops and returns the indices of their constraints. Scattered loops and groups join
/// random nodes with random references: first nodes of path segments. Their place is random within reach_m of
/// the reference, with any heading, and their information is that of a random loop of the graph. Successive
/// nodes of a group move as in the true poses `map_T_node`. The loops of a group agree exactly, so they are
/// harder to reject than loops of a matcher. Adds nothing to a graph without enabled loops. Slips are no
/// loops: see bent().
std::vector<std::size_t> add_false_loops(PoseGraph& graph, const std::vector<mrpt::math::TPose2D>& map_T_node,
                                         const FalseLoopOptions& options);

struct FalseLoopBenchmarkOptions {
  /// Numbers of added false loops, in percent of the accepted loops. Numbers of bent stretches, in percent of
  /// all stretches; shares above 100 % are left out.
  std::vector<double> shares_percent{10, 20, 50, 100, 200, 500};
  std::vector<FalseLoopKind> kinds{FalseLoopKind::kScattered, FalseLoopKind::kGroups, FalseLoopKind::kNearby,
                                   FalseLoopKind::kSlips};
  SeedRange seeds;
};

/// A graph with true loops, and a function that returns the error of given node poses.
struct LoopTrial {
  PoseGraph graph;                            ///< optimised graph
  std::vector<mrpt::math::TPose2D> unlooped;  ///< poses of the nodes before any loop was closed
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
  std::size_t false_kept = 0;  ///< false loops that stay enabled
  std::size_t true_lost = 0;   ///< true loops that are rejected
  double milliseconds = 0;
};

struct FalseLoopRow {
  std::string log;
  FalseLoopKind kind = FalseLoopKind::kScattered;
  double share_percent = 0;
  std::uint64_t seed = 1;  ///< seed for drawing the false loops
  std::size_t true_loops = 0;
  std::size_t false_loops = 0;  ///< number of added false loops, or of bent stretches
  // The first two treatments start at the poses before any loop was closed.
  LoopTrialOutcome undefended;  ///< optimised with all loops
  LoopTrialOutcome defended;    ///< rejects outlier loops as the mapper does
  LoopTrialOutcome from_map;    ///< as `defended`, but starts at the finished map
};

struct FalseLoopLog {
  std::string name;
  std::size_t nodes = 0;
  std::size_t loops = 0;
  LoopTrial::Error map;        ///< error of the map without false loops
  LoopTrial::Error front_end;  ///< error of the front end's poses, before any loop was closed
};

struct FalseLoopBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<FalseLoopLog> logs;
  std::vector<FalseLoopRow> rows;  ///< ordered by log, kind, share and seed
};

/// Adds false loops of one kind to copies of the graph, or bends its path, and tries each treatment. The
/// number of false loops is `share_percent` percent of the number of true loops. Leaves FalseLoopRow::log
/// empty.
FalseLoopRow run_loop_trial(const LoopTrial& trial, FalseLoopKind kind, double share_percent,
                            std::uint64_t seed);

/// Maps each log once and tries each share of each kind with each seed. Throws UserError as open_log() and
/// read_relations().
FalseLoopBenchmark run_false_loop_benchmark(const std::vector<BenchmarkLog>& logs,
                                            const FalseLoopBenchmarkOptions& options,
                                            const ProgressObserver& observer);

/// The report of the `false-loops` command. In JSON, each element of "rows" has the statistics over the seeds
/// of each treatment: "undefended", "defended" and "from_map". Each kind of false loops has a
/// plot.
BenchReport false_loop_report(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                              const std::string& machine);

}  // namespace psi_slam
