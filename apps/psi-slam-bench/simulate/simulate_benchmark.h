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
#include "map/trajectory/relations_metric.h"
#include "psi_slam/mapping_result.h"
#include "simulate/covariance_check.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct SimulateOptions {
  std::vector<double> path_m = {500, 1000, 2000, 5000, 10000};
  std::uint64_t seed = 1;
  double corridors_m = 0;    ///< length of the corridors of all buildings; 0: a third of the path
  std::size_t people = 5;    ///< number of people for every 500 m of path, or of three times corridors_m
  double glass_share = 0.1;  ///< share of glass in the front walls of rooms and in the outer walls
  double max_range_m = ScanSimulatorOptions().max_range_m;  ///< largest range of the laser
  double range_noise_m = ScanSimulatorOptions().noise_m;    ///< standard deviation of a range
  int threads = 1;                                          ///< number of threads that match loops
};

/// Mean, largest value, and 99th percentile: the least value that at least 99 % of the values do not exceed.
struct TimeSummary {
  double mean = 0;
  double p99 = 0;
  double max = 0;
};

/// Figures of one mapped run.
struct SimulateRow {
  double path_m = 0;
  std::size_t scans = 0;
  std::size_t rooms = 0;
  double corridors_m = 0;
  std::size_t nodes = 0;
  std::size_t local_maps = 0;

  double error_mean_m = 0;  ///< mean distance from the truth; both paths are aligned at the first scan
  double error_max_m = 0;
  double aligned_mean_m = 0;   ///< mean distance from the truth after the best rigid alignment
  double relation_mean_m = 0;  ///< mean error over relations between random pairs of scans
  double relation_mean_deg = 0;
  double odometry_error_mean_m = 0;  ///< mean error of odometry alone, aligned like error_mean_m

  std::size_t loops = 0;        ///< accepted loops
  std::size_t false_loops = 0;  ///< accepted loops that contradict the truth

  std::vector<NormalisedErrors> covariances;  ///< see check_covariances()

  TimeSummary scan_ms;          ///< time of Mapper::add for one scan
  TimeSummary optimisation_ms;  ///< time of each optimisation of the graph while mapping
  double add_s = 0;             ///< time of Mapper::add for all scans
  double finish_s = 0;          ///< time of Mapper::finish, after the last scan
  double peak_memory_mib = 0;   ///< memory of simulation and mapping, up to the finished map
  std::vector<std::pair<std::string, double>> stages_s;  ///< times of the stages of the mapper
};

/// A loop is false if its position or its heading differs from the truth by more than this.
inline constexpr double kFalseLoop_m = 0.5;
inline constexpr double kFalseLoop_deg = 5;

/// Number of pairs of scans for the relations metric.
inline constexpr std::size_t kRelations = 2000;

/// Summary of the values; zeros without values.
TimeSummary summary_of_times(std::vector<double> values);

/// Options of a run with a path of `path_m` metres, and with the seed, people, glass and laser of `options`.
SimulatedLogOptions simulated_run_options(const SimulateOptions& options, double path_m);

/// Relations of the true path between `count` random pairs of scans. `truth` must not be empty.
std::vector<Relation> draw_relations(const Trajectory& truth, std::size_t count, std::uint64_t seed);

/// Summary of the distances, in metres, between two paths of the same scans, aligned at their first poses.
ErrorSummary trajectory_error_m(const std::vector<mrpt::math::TPose2D>& path, const Trajectory& truth);

/// Number of accepted loops that contradict the truth.
std::size_t count_false_loops(const MappingResult& result, const Trajectory& truth);

/// Simulates and maps a run in this process with the default settings. Calls `progress` with the share that
/// is done, in [0, 1].
SimulateRow map_simulated_run(const SimulatedLogOptions& run, int threads,
                              const std::function<void(double)>& progress);

/// Maps a run of each length, each in a child process of its own. `observer` gets the progress in metres of
/// path.
std::vector<SimulateRow> run_simulate_benchmark(const SimulateOptions& options,
                                                const ProgressObserver& observer);

/// Conversion of a row to text and back, for the message of a child process. Restores every figure exactly.
std::string row_text(const SimulateRow& row);
SimulateRow row_of_text(const std::string& text);

/// Length as text: "500 m", "10 km".
std::string metres_text(double metres);

/// The report of the `simulate` command. JSON has an object for each run in "drives". The plots show how
/// error, time and memory grow with the length of the path.
BenchReport simulate_report(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                            const std::string& machine);

}  // namespace psi_slam
