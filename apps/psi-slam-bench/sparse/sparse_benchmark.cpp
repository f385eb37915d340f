// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/sparse_benchmark.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "base/number_text.h"
#include "common/measured_map.h"
#include "map/exports/mapped_trajectory.h"
#include "map/exports/unmatched_scans.h"
#include "map/rendering/map_image.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::array<const char*, 2> kEveryNthLogs = {"fr079", "mit-csail"};
constexpr std::array<std::size_t, 2> kEveryNth = {3, 5};
constexpr int kPictureSide_px = 1200;

/// Figures of a mapped log. `path` holds the poses to evaluate.
SparseRow row_of(const BenchmarkLog& log, const Settings& settings, const MeasuredMap& map,
                 const Trajectory& path) {
  SparseRow row;
  row.log = log.name;
  row.seed = settings.run.seed;
  row.figures = figures_of(map, path, read_relations(log.relations.value()));
  row.nodes = map.result.node_frames.size();
  row.unmatched = unmatched_scans(map.result.frames, runs_of(map.result)).count;
  row.loops = loops_accepted(map.result);
  row.costs = node_costs(map.result.frames, map.add_ms);
  return row;
}

std::string step_text(const ThinningStep& step) {
  return trimmed_text(step.distance_m, 2) + " m / " + trimmed_text(step.turn_rad, 2) + " rad";
}

std::string picture_of(const MappingResult& result, const Settings& settings) {
  MapPictureOptions picture;
  picture.max_side_px = picture.min_side_px = kPictureSide_px;
  return map_picture(*draw_grid_map(result.log, mapped_poses(result), settings.map), picture).png;
}

/// Runs the parts one after the other and reports their progress.
class Benchmark {
 public:
  Benchmark(const SparseLogs& logs, const SparseOptions& options, const ProgressObserver& observer)
      : logs_(logs), options_(options), observer_(observer) {
    const auto seeds = static_cast<double>(options.seeds.count());
    if (options.has(kThinnedPart)) all_ += static_cast<double>(logs.dense.size()) * (seeds + 1);
    if (options.has(kEveryNthPart)) all_ += static_cast<double>(every_nth_logs().size()) * 2 * seeds;
    if (options.has(kSparsePart)) all_ += static_cast<double>(logs.sparse.size()) * seeds;
    if (options.has(kSimulatedPart))
      all_ += static_cast<double>(options.sensors.max_ranges_m.size() * options.sensors.spacings_deg.size());
  }

  SparseBenchmark run() {
    if (all_ == 0)
      throw UserError("--parts and --logs leave nothing to run: choose other parts, or logs that they use");
    if (options_.has(kThinnedPart))
      for (const BenchmarkLog& log : logs_.dense) run_thinned_log(log);
    if (options_.has(kEveryNthPart))
      for (const BenchmarkLog& log : every_nth_logs())
        for (const std::size_t nth : kEveryNth) run_as_read(log, nth, "1 of " + std::to_string(nth), false);
    if (options_.has(kSparsePart))
      for (const BenchmarkLog& log : logs_.sparse) run_as_read(log, 1, "all", true);
    if (options_.has(kSimulatedPart)) run_simulated();
    return std::move(benchmark_);
  }

 private:
  std::vector<BenchmarkLog> every_nth_logs() const {
    std::vector<BenchmarkLog> logs;
    for (const BenchmarkLog& log : logs_.dense)
      if (std::find(kEveryNthLogs.begin(), kEveryNthLogs.end(), log.name) != kEveryNthLogs.end())
        logs.push_back(log);
    return logs;
  }

  void show(const std::string& doing) { observer_(doing, done_++, all_); }

  void run_thinned_log(const BenchmarkLog& log) {
    const ThinningStep step;
    show(log.name + ", all scans");
    const double floor_m = thinned_floor_m(log, sparse_settings(log, options_, options_.seeds.first), step);
    for (const std::uint64_t seed : options_.seeds.all()) {
      show(log.name + ", " + step_text(step));
      benchmark_.rows.push_back(run_thinned(log, sparse_settings(log, options_, seed), step));
      benchmark_.rows.back().floor_m = floor_m;
    }
  }

  void run_as_read(const BenchmarkLog& log, std::size_t every_nth, const std::string& kept, bool draw) {
    for (const std::uint64_t seed : options_.seeds.all()) {
      show(log.name + ", " + kept);
      const Settings settings = sparse_settings(log, options_, seed, every_nth);
      const MeasuredMap map =
          map_measured(*open_log(log.log, log_options(settings)), mapper_options(settings));
      SparseRow row = row_of(log, settings, map, trajectory_of(map.result.frames));
      row.kept = kept;
      benchmark_.rows.push_back(std::move(row));
      if (draw && seed == options_.seeds.first)
        benchmark_.pictures.push_back({log.name, picture_of(map.result, settings)});
    }
  }

  void run_simulated() {
    SensorSweepOptions sensors = options_.sensors;
    sensors.seed = options_.seeds.first;
    benchmark_.sensors = run_sensor_sweep(
        sensors, benchmark_settings({}, options_.assignments),
        [&](const std::string& doing, double done, double) { observer_(doing, done_ + done, all_); });
  }

  const SparseLogs& logs_;
  const SparseOptions& options_;
  const ProgressObserver& observer_;
  double all_ = 0;  ///< number of runs and of simulated sensors
  double done_ = 0;
  SparseBenchmark benchmark_;
};

}  // namespace

bool SparseOptions::has(const std::string& part) const {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

Settings sparse_settings(const BenchmarkLog& log, const SparseOptions& options, std::uint64_t seed,
                         std::size_t every_nth) {
  std::vector<std::string> assignments{"run.threads=1", "run.seed=" + std::to_string(seed),
                                       "log.every_nth_scan=" + std::to_string(every_nth)};
  assignments.insert(assignments.end(), options.assignments.begin(), options.assignments.end());
  return benchmark_settings(log.ini, assignments);
}

SparseRow run_thinned(const BenchmarkLog& log, const Settings& settings, const ThinningStep& step) {
  StepThinnedSource source(open_log(log.log, log_options(settings)), step);
  const MeasuredMap map = map_measured(source, mapper_options(settings));
  SparseRow row = row_of(log, settings, map, put_poses_back(source.scans(), mapped_poses(map.result)));
  row.kept = step_text(step);
  return row;
}

double thinned_floor_m(const BenchmarkLog& log, const Settings& settings, const ThinningStep& step) {
  StepThinnedSource thinned(open_log(log.log, log_options(settings)), step);
  while (thinned.next()) {
  }
  const MappingResult all =
      map_source(*open_log(log.log, log_options(settings)), mapper_options(settings), [](double) {});
  const Trajectory path = put_poses_back(thinned.scans(), poses_of_kept(thinned.scans(), mapped_poses(all)));
  return evaluate_path(path, read_relations(log.relations.value())).errors.translation_abs_m.mean;
}

SparseBenchmark run_sparse_benchmark(const SparseLogs& logs, const SparseOptions& options,
                                     const ProgressObserver& observer) {
  SparseBenchmark benchmark = Benchmark(logs, options, observer).run();
  for (const auto* some : {&logs.dense, &logs.sparse})
    for (LogIdentity& identity : identities_of(*some)) benchmark.identities.push_back(std::move(identity));
  benchmark.without_relations = logs.without_relations;
  return benchmark;
}

}  // namespace psi_slam
