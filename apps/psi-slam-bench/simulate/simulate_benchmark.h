// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of scale: simulated drives of growing length are mapped and compared with the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "simulate/covariance_check.h"
#include "psi_slam/mapping_result.h"
#include "evaluation/relations_metric.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct SimulateOptions {
  std::vector<double> path_m = {500, 1000, 2000, 5000, 10000};
  std::uint64_t seed = 1;
  std::size_t people = 5;    ///< for every 500 m of path
  double glass_share = 0.1;  ///< of rooms' fronts and outer walls
  int threads = 1;           ///< that match loops
};

/// The mean, and the least of the values that 99 of 100 do not exceed.
struct MeanAndP99 {
  double mean = 0;
  double p99 = 0;
};

/// One drive, mapped.
struct SimulateRow {
  double path_m = 0;
  std::size_t scans = 0;
  std::size_t rooms = 0;
  double corridors_m = 0;
  std::size_t nodes = 0;
  std::size_t local_maps = 0;

  double error_mean_m = 0;  ///< distance from the truth, both laid on each other at the first scan
  double error_max_m = 0;
  double relation_mean_m = 0;  ///< of the relations metric over pairs of scans drawn at random
  double relation_mean_deg = 0;
  double odometry_error_mean_m = 0;  ///< as error_mean_m, of odometry alone

  std::size_t loops = 0;        ///< constraints that the finished graph keeps
  std::size_t false_loops = 0;  ///< of these, those that the truth contradicts

  std::vector<NormalisedErrors> covariances;  ///< see check_covariances()

  MeanAndP99 scan_ms;          ///< of Mapper::add
  double add_s = 0;            ///< of all scans
  double finish_s = 0;         ///< of all that comes after the last scan
  double peak_memory_mib = 0;  ///< of the process that made and mapped the drive, up to the finished map
  std::vector<std::pair<std::string, double>> stages_s;  ///< the mapper's own account of its time
};

/// A loop is false when it is farther than this from the truth.
inline constexpr double kFalseLoop_m = 0.5;
inline constexpr double kFalseLoop_deg = 5;

/// Pairs of scans for the relations metric.
inline constexpr std::size_t kRelations = 2000;

/// Zeros for no values.
MeanAndP99 mean_and_p99(std::vector<double> values);

/// The drive of one length: with the options' seed, people and glass.
SimulatedLogOptions simulated_run_options(const SimulateOptions& options, double path_m);

/// True relations between random pairs of scans. `truth` is not empty.
std::vector<Relation> draw_relations(const Trajectory& truth, std::size_t count, std::uint64_t seed);

/// Distances between two paths of the same scans, laid on each other at their first poses.
ErrorSummary trajectory_error_m(const std::vector<mrpt::math::TPose2D>& path, const Trajectory& truth);

/// The loops that the graph keeps and the truth contradicts.
std::size_t count_false_loops(const MappingResult& result, const Trajectory& truth);

/// Makes and maps one drive in this process with the default settings. `progress` is
/// called with the share done, in [0, 1].
SimulateRow map_simulated_run(const SimulatedLogOptions& drive, int threads,
                                const std::function<void(double)>& progress);

/// Every length in a child process of its own. The observer is told what is being done, how many metres are
/// done, and of how many.
std::vector<SimulateRow> run_simulate_benchmark(
    const SimulateOptions& options,
    const std::function<void(const std::string& doing, double done, double all)>& observer);

}  // namespace psi_slam
