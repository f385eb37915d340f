// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/known_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "common/aligned_error.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/mapped_trajectory.h"
#include "psi_slam/mapper.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "simulation/simulated_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kScanRate_hz = 5;

void make_blind(LaserScan& scan) {
  for (float& range_m : scan.ranges_m) range_m = std::numeric_limits<float>::infinity();
}

void cut_ranges(double max_range_m, LaserScan& scan) {
  for (float& range_m : scan.ranges_m)
    if (range_m > static_cast<float>(max_range_m)) range_m = std::numeric_limits<float>::infinity();
}

/// Path of a map with the scans that were thinned out, at the times of the log.
Trajectory with_all_scans(const MappingResult& map, const KnownRun& run) {
  const Trajectory& whole = run.truth->map;
  Trajectory path;
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    const std::size_t scan = run.scans[i];
    const std::size_t next = i + 1 < run.scans.size() ? run.scans[i + 1] : scan + 1;
    const std::size_t end = next - scan <= run.kept_every_nth ? next : scan + 1;
    for (std::size_t j = scan; j < end; ++j)
      path.push_back(
          {whole[j].time_us, compose(map.frames[i].map_T_robot, between(whole[scan].pose, whole[j].pose))});
  }
  return path;
}

}  // namespace

KnownRun simulated_run(std::uint64_t seed, double path_m, RandomDraws& draws) {
  SimulatedLogOptions options = simulated_log_options(path_m, seed);
  options.path.scan_rate_hz = kScanRate_hz;
  options.people = draws.index(4);
  options.scan.noise_m = 0.005 + 0.015 * draws.share();
  SimulatedLog log(options);
  KnownRun run;
  run.mapper = mapper_options(Settings{});
  while (std::optional<Frame> frame = log.next()) {
    run.scans.push_back(run.frames.size());
    run.frames.push_back(*std::move(frame));
    run.world_T_robot.push_back(log.world_T_robot());
  }
  return run;
}

std::pair<KnownRun, MappingResult> run_of_log(const BenchmarkLog& log) {
  const Settings settings = benchmark_settings(log.ini);
  KnownRun run;
  run.log = log.name;
  run.mapper = mapper_options(settings);
  const auto source = open_log(log.log, log_options(settings));
  while (std::optional<Frame> frame = source->next()) {
    run.scans.push_back(run.frames.size());
    run.frames.push_back(*std::move(frame));
  }
  constexpr std::size_t kLeastScans = 100;
  if (run.frames.size() < kLeastScans)
    throw UserError(log.log.string() + " has " + std::to_string(run.frames.size()) +
                    " scans; expected at least " + std::to_string(kLeastScans) + " to make faults");
  MappingResult map = map_of(run);
  run.world_T_robot = mapped_poses(map);
  run.truth =
      std::make_shared<LogTruth>(LogTruth{trajectory_of(map.frames), read_relations(log.relations.value())});
  return {std::move(run), std::move(map)};
}

MappingResult map_of(const KnownRun& run, bool close_loops) {
  MapperOptions options = run.mapper;
  options.close_loops = close_loops;
  Mapper mapper(options);
  for (const Frame& frame : run.frames) mapper.add(frame);
  return mapper.finish();
}

double mean_error_m(const MappingResult& map, const KnownRun& run) {
  if (!run.truth) return aligned_error_m(mapped_poses(map), run.world_T_robot);
  return evaluate_relations(with_all_scans(map, run), run.truth->relations).translation_abs_m.mean;
}

KnownRun degraded(const KnownRun& run, std::size_t keep_every_nth, double max_range_m, double noise,
                  RandomDraws& draws) {
  KnownRun kept;
  kept.log = run.log;
  kept.mapper = run.mapper;
  kept.kept_every_nth = keep_every_nth;
  kept.truth = run.truth;
  std::optional<TPose2D> last;
  TPose2D odom_T_robot(0, 0, 0);
  for (std::size_t i = 0; i < run.frames.size(); i += keep_every_nth) {
    Frame frame = run.frames[i];
    const TPose2D step = last ? between(*last, frame.odom_T_robot) : TPose2D(0, 0, 0);
    last = frame.odom_T_robot;
    const double root_m = std::sqrt(portable::hypot(step.x, step.y));
    const double turn_rad = noise * 0.02 * root_m * draws.normal();
    const double along_m = noise * 0.03 * root_m * draws.normal();
    odom_T_robot = compose(odom_T_robot, TPose2D(step.x + along_m, step.y, step.phi + turn_rad));
    frame.odom_T_robot = odom_T_robot;
    frame.index = kept.frames.size();
    cut_ranges(max_range_m, frame.scan);
    for (CompanionScan& companion : frame.companions) cut_ranges(max_range_m, companion.scan);
    kept.frames.push_back(std::move(frame));
    kept.world_T_robot.push_back(run.world_T_robot[i]);
    kept.scans.push_back(run.scans[i]);
  }
  return kept;
}

void slip(KnownRun& run, std::size_t from, std::size_t to, const TPose2D& slipped) {
  for (std::size_t i = from; i < to; ++i) {
    make_blind(run.frames[i].scan);
    for (CompanionScan& companion : run.frames[i].companions) make_blind(companion.scan);
  }
  const std::size_t middle = (from + to) / 2;
  const TPose2D before = run.frames[middle - 1].odom_T_robot;
  const TPose2D first = run.frames[middle].odom_T_robot;
  const TPose2D jumped = compose(compose(before, between(before, first)), slipped);
  for (std::size_t i = middle; i < run.frames.size(); ++i)
    run.frames[i].odom_T_robot = compose(jumped, between(first, run.frames[i].odom_T_robot));
}

void carry(KnownRun& run, std::size_t off, std::size_t on) {
  const TPose2D odom_T_off = run.frames[off - 1].odom_T_robot;
  const TPose2D odom_T_on = run.frames[on].odom_T_robot;
  for (std::size_t i = on; i < run.frames.size(); ++i)
    run.frames[i].odom_T_robot = compose(odom_T_off, between(odom_T_on, run.frames[i].odom_T_robot));
  const auto erase = [&](auto& all) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(off), all.begin() + static_cast<std::ptrdiff_t>(on));
  };
  erase(run.frames);
  erase(run.world_T_robot);
  erase(run.scans);
  for (std::size_t i = 0; i < run.frames.size(); ++i) run.frames[i].index = i;
}

void pause(KnownRun& run, std::size_t at, double pause_s) {
  const TPose2D odom_T_restart = run.frames[at].odom_T_robot;
  for (std::size_t i = at; i < run.frames.size(); ++i) {
    run.frames[i].time_us += static_cast<TimeUs>(1e6 * pause_s);
    run.frames[i].odom_T_robot = between(odom_T_restart, run.frames[i].odom_T_robot);
  }
}

std::size_t frame_after(const KnownRun& run, std::size_t from, double path_m) {
  double travelled_m = 0;
  std::size_t i = from;
  for (; i + 1 < run.frames.size() && travelled_m < path_m; ++i) {
    const TPose2D& a = run.world_T_robot[i];
    const TPose2D& b = run.world_T_robot[i + 1];
    travelled_m += distance_m(a, b);
  }
  return i;
}

}  // namespace psi_slam
