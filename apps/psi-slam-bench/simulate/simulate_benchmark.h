// SPDX-License-Identifier: BSD-3-Clause
// Maps simulated runs of growing length and compares the maps with the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "batch/workers.h"
#include "common/bench_report.h"
#include "evaluation/relations_metric.h"
#include "psi_slam/mapping_result.h"
#include "simulate/covariance_check.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct SimulateOptions {
  std::vector<double> path_m = {500, 1000, 2000, 5000, 10000};
  std::uint64_t seed = 1;
  std::size_t people = 5;    ///< for every 500 m of path
  double glass_share = 0.1;  ///< of the front walls of rooms and of the outer walls
  int threads = 1;           ///< for matching loops
};

/// Mean, and the least value that 99 % of the values do not exceed.
struct MeanAndP99 {
  double mean = 0;
  double p99 = 0;
};

/// Figures of one mapped run.
struct SimulateRow {
  double path_m = 0;
  std::size_t scans = 0;
  std::size_t rooms = 0;
  double corridors_m = 0;
  std::size_t nodes = 0;
  std::size_t local_maps = 0;

  double error_mean_m = 0;  ///< distance from the truth, with both paths aligned at the first scan
  double error_max_m = 0;
  double relation_mean_m = 0;  ///< relations metric over random pairs of scans
  double relation_mean_deg = 0;
  double odometry_error_mean_m = 0;  ///< mean error of odometry alone, aligned like error_mean_m

  std::size_t loops = 0;        ///< in the finished graph
  std::size_t false_loops = 0;  ///< of these, loops that contradict the truth

  std::vector<NormalisedErrors> covariances;  ///< see check_covariances()

  MeanAndP99 scan_ms;          ///< of Mapper::add
  double add_s = 0;            ///< of all scans
  double finish_s = 0;         ///< after the last scan
  double peak_memory_mib = 0;  ///< of simulation and mapping, up to the finished map
  std::vector<std::pair<std::string, double>> stages_s;  ///< times of the stages of the mapper
};

/// A loop is false if it is farther than this from the truth.
inline constexpr double kFalseLoop_m = 0.5;
inline constexpr double kFalseLoop_deg = 5;

/// Number of pairs of scans for the relations metric.
inline constexpr std::size_t kRelations = 2000;

/// Zeros without values.
MeanAndP99 mean_and_p99(std::vector<double> values);

/// A run of one length with the seed, people and glass of the options.
SimulatedLogOptions simulated_run_options(const SimulateOptions& options, double path_m);

/// True relations between random pairs of scans. `truth` must not be empty.
std::vector<Relation> draw_relations(const Trajectory& truth, std::size_t count, std::uint64_t seed);

/// Distances between two paths of the same scans, aligned at their first poses.
ErrorSummary trajectory_error_m(const std::vector<mrpt::math::TPose2D>& path, const Trajectory& truth);

/// Number of loops in the finished graph that contradict the truth.
std::size_t count_false_loops(const MappingResult& result, const Trajectory& truth);

/// Simulates and maps a run in this process with the default settings. Calls `progress` with the share that
/// is done, in [0, 1].
SimulateRow map_simulated_run(const SimulatedLogOptions& run, int threads,
                              const std::function<void(double)>& progress);

/// Maps a run of each length, each in a child process of its own. Work is counted in metres of path.
std::vector<SimulateRow> run_simulate_benchmark(const SimulateOptions& options,
                                                const ProgressObserver& observer);

/// Messages from the child process; every figure is restored exactly.
std::string row_text(const SimulateRow& row);
SimulateRow row_of_text(const std::string& text);

/// "500 m", "10 km".
std::string metres_text(double metres);

/// The report of the `simulate` command. JSON has an object for each run in "drives". The plots show how
/// error, time and memory grow with the length of the path.
BenchReport simulate_report(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                            const std::string& machine);

}  // namespace psi_slam
