// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulate_benchmark.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/portable_math.h"
#include "common/aligned_error.h"
#include "common/benchmark_logs.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/run_summary.h"
#include "psi_slam/mapper.h"
#include "session/settings.h"
#include "simulate/forked_work.h"
#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Clock = std::chrono::steady_clock;

constexpr double kPeoplePer_m = 500;  // length of path that SimulateOptions::people refers to
constexpr double kScansShare = 0.6;  // share of the progress for adding scans; the rest is for Mapper::finish

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void compare_with_truth(const MappingResult& result, const Trajectory& truth, std::uint64_t seed,
                        SimulateRow& row) {
  std::vector<TPose2D> mapped;
  std::vector<TPose2D> odometry;
  for (const FrameRecord& frame : result.frames) {
    mapped.push_back(frame.map_T_robot);
    odometry.push_back(frame.odom_T_robot);
  }
  std::vector<TPose2D> true_poses;
  for (std::size_t i = 0; i < mapped.size(); ++i) true_poses.push_back(truth[i].pose);
  const ErrorSummary error = trajectory_error_m(mapped, truth);
  row.error_mean_m = error.mean;
  row.error_max_m = error.max;
  row.aligned_mean_m = aligned_error_m(mapped, true_poses);
  row.odometry_error_mean_m = trajectory_error_m(odometry, truth).mean;
  const RelationsMetric metric = error_of(result.frames, draw_relations(truth, kRelations, seed));
  row.relation_mean_m = metric.translation_abs_m.mean;
  row.relation_mean_deg = metric.rotation_abs_deg.mean;
  row.loops = loops_accepted(result);
  row.false_loops = count_false_loops(result, truth);
  row.covariances = check_covariances(result, truth, seed);
}

}  // namespace

// Conversions of the structs to and from nlohmann::json.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TimeSummary, mean, p99, max)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NormalisedErrors, of, count, mean, median, beyond_95)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimulateRow, path_m, scans, rooms, corridors_m, nodes, local_maps,
                                   error_mean_m, error_max_m, aligned_mean_m, relation_mean_m,
                                   relation_mean_deg, odometry_error_mean_m, loops, false_loops, covariances,
                                   scan_ms, optimisation_ms, add_s, finish_s, peak_memory_mib, stages_s)

std::string row_text(const SimulateRow& row) {
  return nlohmann::json(row).dump();
}

SimulateRow row_of_text(const std::string& text) {
  return nlohmann::json::parse(text).get<SimulateRow>();
}

TimeSummary summary_of_times(std::vector<double> values) {
  if (values.empty()) return {};
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const std::size_t rank = (values.size() * 99 + 99) / 100 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return {sum / static_cast<double>(values.size()), values[rank],
          *std::max_element(values.begin(), values.end())};
}

SimulatedLogOptions simulated_run_options(const SimulateOptions& options, double path_m) {
  const double usual_path_m = options.corridors_m > 0 ? kVisits * options.corridors_m : path_m;
  SimulatedLogOptions run = simulated_log_options(usual_path_m, options.seed);
  run.path.path_m = path_m;
  run.plan.glass_share = options.glass_share;
  run.scan.max_range_m = options.max_range_m;
  run.scan.noise_m = options.range_noise_m;
  run.people = static_cast<std::size_t>(
      std::lround(std::ceil(static_cast<double>(options.people) * usual_path_m / kPeoplePer_m)));
  return run;
}

std::vector<Relation> draw_relations(const Trajectory& truth, std::size_t count, std::uint64_t seed) {
  SimulationRandom random(seed, SimulationRandom::Stream::kRelations);
  std::vector<Relation> relations;
  while (relations.size() < count) {
    const StampedPose& first = truth[random.index(truth.size())];
    const StampedPose& second = truth[random.index(truth.size())];
    relations.push_back({first.time_us, second.time_us, between(first.pose, second.pose)});
  }
  return relations;
}

ErrorSummary trajectory_error_m(const std::vector<TPose2D>& path, const Trajectory& truth) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TPose2D there = between(path.front(), path[i]);
    const TPose2D truly = between(truth.front().pose, truth[i].pose);
    errors.push_back(distance_m(truly, there));
  }
  return summarize(std::move(errors));
}

std::size_t count_false_loops(const MappingResult& result, const Trajectory& truth) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(), [&](const LoopRecord& loop) {
        if (loop.state != LoopState::kAccepted) return false;
        const TPose2D anchor_T_node =
            between(truth[result.node_frames[loop.anchor]].pose, truth[loop.frame].pose);
        const TPose2D off = between(anchor_T_node, loop.anchor_T_node);
        return portable::hypot(off.x, off.y) > kFalseLoop_m ||
               std::abs(std::remainder(off.phi, 2 * M_PI)) > kFalseLoop_deg * M_PI / 180;
      }));
}

SimulateRow map_simulated_run(const SimulatedLogOptions& run, int threads,
                              const std::function<void(double)>& progress) {
  Settings settings;
  settings.run.threads = threads;
  Mapper mapper(mapper_options(settings));
  SimulatedLog log(run);
  Trajectory truth;
  std::vector<double> times_ms;
  while (std::optional<Frame> frame = log.next()) {
    truth.push_back({frame->time_us, log.world_T_robot()});
    const Clock::time_point begin = Clock::now();
    mapper.add(*std::move(frame));
    times_ms.push_back(1e3 * seconds_since(begin));
    progress(kScansShare * log.progress());
  }
  const Clock::time_point begin = Clock::now();
  const MappingResult result = mapper.finish([&](double share) {
    progress(kScansShare + (1 - kScansShare) * share);
    return true;
  });

  SimulateRow row;
  row.finish_s = seconds_since(begin);
  row.peak_memory_mib = peak_memory_mib();
  row.path_m = log.travelled_m();
  row.scans = truth.size();
  row.rooms = log.plan().rooms();
  row.corridors_m = log.plan().corridors_m();
  row.nodes = result.node_frames.size();
  row.local_maps = result.local_maps.size();
  row.add_s = std::accumulate(times_ms.begin(), times_ms.end(), 0.0) / 1e3;
  row.scan_ms = summary_of_times(std::move(times_ms));
  std::vector<double> optimisations_ms;
  for (const FrameRecord& frame : result.frames)
    if (frame.pose_graph_ms > 0) optimisations_ms.push_back(frame.pose_graph_ms);
  row.optimisation_ms = summary_of_times(std::move(optimisations_ms));
  for (const StageTiming& stage : result.stages) row.stages_s.emplace_back(stage.name, stage.total_s);
  compare_with_truth(result, truth, run.path.seed, row);
  return row;
}

std::vector<SimulateRow> run_simulate_benchmark(const SimulateOptions& options,
                                                const ProgressObserver& observer) {
  const double all_m = std::accumulate(options.path_m.begin(), options.path_m.end(), 0.0);
  double done_m = 0;
  std::vector<SimulateRow> rows;
  for (const double path_m : options.path_m) {
    const std::string doing = metres_text(path_m);
    observer(doing, done_m, all_m);
    const std::string row = run_forked(
        [&](const TextObserver& report) {
          int reported = 0;
          return row_text(
              map_simulated_run(simulated_run_options(options, path_m), options.threads, [&](double share) {
                const int now = static_cast<int>(1000 * share);
                if (now == reported) return;
                reported = now;
                report(std::to_string(now));
              }));
        },
        [&](const std::string& per_mille) {
          observer(doing, done_m + path_m * std::stoi(per_mille) / 1000, all_m);
        });
    rows.push_back(row_of_text(row));
    done_m += path_m;
  }
  return rows;
}

}  // namespace psi_slam
