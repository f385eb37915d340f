// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/sensor_sweep.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/number_text.h"
#include "base/worker_pool.h"
#include "common/benchmark_logs.h"
#include "map/exports/unmatched_scans.h"
#include "simulate/simulate_benchmark.h"
#include "sparse/step_thinned_source.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kFieldOfView_deg = 180;
constexpr double kSmallestBuilding_m = 8;  // range of the sensor for a building of scale 1
constexpr double kTurn_rad = 0.5;          // rotation by odometry after which a scan is kept
constexpr double kResolution_m = 0.02;     // cell size of the simulator in a building of scale 1

/// All scans of a simulated run, with the true poses.
struct SimulatedScans {
  std::vector<Frame> frames;
  std::vector<TPose2D> world_T_robot;
  double path_m = 0;
};

class MemorySource : public FrameSource {
 public:
  explicit MemorySource(const std::vector<Frame>& frames) : frames_(frames) {}
  std::optional<Frame> next() override {
    return next_ < frames_.size() ? std::optional(frames_[next_++]) : std::nullopt;
  }
  double progress() const override {
    return static_cast<double>(next_) / static_cast<double>(frames_.size());
  }

 private:
  const std::vector<Frame>& frames_;
  std::size_t next_ = 0;
};

SimulatedScans simulate(const SensorSweepOptions& options, double max_range_m, double spacing_deg) {
  const double scale = building_scale(max_range_m);
  SimulatedLogOptions run = simulated_log_options(options.path_m * scale, options.seed);
  run.plan.scale = scale;
  run.path.scan_rate_hz = run.path.max_speed_m_s / options.steps_m.front();
  run.scan.field_of_view_rad = radians_from_degrees(kFieldOfView_deg);
  run.scan.beams = static_cast<std::size_t>(std::lround(kFieldOfView_deg / spacing_deg)) + 1;
  run.scan.max_range_m = max_range_m;
  run.scan.resolution_m = kResolution_m * std::sqrt(scale);
  SimulatedLog log(run);
  SimulatedScans scans;
  while (std::optional<Frame> frame = log.next()) {
    scans.frames.push_back(*std::move(frame));
    scans.world_T_robot.push_back(log.world_T_robot());
  }
  scans.path_m = log.travelled_m();
  return scans;
}

SensorSweepRow map_with_step(const SimulatedScans& simulated, const ThinningStep& step,
                             const MapperOptions& mapper, std::uint64_t seed) {
  StepThinnedSource source(std::make_unique<MemorySource>(simulated.frames), step);
  const MappingResult result = map_source(source, mapper, [](double) {});
  const std::vector<TPose2D> poses = poses_of_kept(source.scans(), simulated.world_T_robot);
  Trajectory truth;
  for (std::size_t i = 0; i < poses.size(); ++i) truth.push_back({result.frames[i].time_us, poses[i]});
  const RelationsMetric error = error_of(result.frames, draw_relations(truth, kRelations, seed));
  SensorSweepRow row;
  row.path_m = simulated.path_m;
  row.scans = truth.size();
  row.unmatched = unmatched_scans(result.frames, runs_of(result)).count;
  row.error_m = error.translation_abs_m.mean;
  row.error_deg = error.rotation_abs_deg.mean;
  row.loops = loops_accepted(result);
  row.false_loops = count_false_loops(result, truth);
  return row;
}

}  // namespace

double building_scale(double max_range_m) {
  return std::sqrt(std::max(1.0, max_range_m / kSmallestBuilding_m));
}

std::vector<SensorSweepRow> run_sensor_sweep(const SensorSweepOptions& options, const Settings& settings,
                                             const ProgressObserver& observer) {
  Settings one_thread = settings;
  one_thread.run.threads = 1;
  const MapperOptions mapper = mapper_options(one_thread);
  const std::size_t spacings = options.spacings_deg.size();
  const std::size_t sensors = options.max_ranges_m.size() * spacings;
  TaskProgress running(sensors, static_cast<double>(sensors), observer);
  WorkerPool pool(options.threads);
  const auto of_sensors =
      map_in_parallel<std::vector<SensorSweepRow>>(pool, sensors, [&](std::size_t sensor) {
        const double max_range_m = options.max_ranges_m[sensor / spacings];
        const double spacing_deg = options.spacings_deg[sensor % spacings];
        running.show(fixed_text(max_range_m, 0) + " m, " + trimmed_text(spacing_deg, 2) + " degrees");
        const SimulatedScans simulated = simulate(options, max_range_m, spacing_deg);
        std::vector<SensorSweepRow> rows;
        for (const double step_m : options.steps_m) {
          const bool all = step_m == options.steps_m.front();
          const ThinningStep step = all ? ThinningStep{0, 0} : ThinningStep{step_m, kTurn_rad};
          SensorSweepRow row = map_with_step(simulated, step, mapper, options.seed);
          row.max_range_m = max_range_m;
          row.spacing_deg = spacing_deg;
          row.step_m = step_m;
          rows.push_back(row);
        }
        running.end(1);
        return rows;
      });
  std::vector<SensorSweepRow> rows;
  for (const std::vector<SensorSweepRow>& of_sensor : of_sensors)
    rows.insert(rows.end(), of_sensor.begin(), of_sensor.end());
  return rows;
}

}  // namespace psi_slam
