// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/faulty_maps.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "base/random_draws.h"
#include "common/benchmark_logs.h"
#include "false_loops/false_loop_benchmark.h"
#include "mapping/carried_frames.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/mapper.h"
#include "simulation/simulated_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kLongestPath = 1.75;  // length of the longest path, in shortest paths
constexpr double kScanRate_hz = 5;
constexpr std::size_t kLoopsKept = 60;  // every nth true loop of a map with false loops is kept

/// Frames of a run and the true pose of the robot at each of them.
struct TrueRun {
  std::vector<Frame> frames;
  std::vector<TPose2D> world_T_robot;
};

TrueRun simulated_run(std::uint64_t seed, double path_m, RandomDraws& draws) {
  SimulatedLogOptions options =
      simulated_log_options(path_m * (1 + draws.share() * (kLongestPath - 1)), seed);
  options.path.scan_rate_hz = kScanRate_hz;
  options.people = draws.index(4);
  options.scan.noise_m = 0.005 + 0.015 * draws.share();
  SimulatedLog log(options);
  TrueRun run;
  while (std::optional<Frame> frame = log.next()) {
    run.frames.push_back(*std::move(frame));
    run.world_T_robot.push_back(log.world_T_robot());
  }
  return run;
}

MappingResult map_of(const std::vector<Frame>& frames, bool close_loops = true) {
  MapperOptions options = mapper_options(Settings{});
  options.close_loops = close_loops;
  Mapper mapper(options);
  for (const Frame& frame : frames) mapper.add(frame);
  return mapper.finish();
}

/// Keeps every nth frame, cuts ranges, and adds a random walk to odometry.
TrueRun degraded(const TrueRun& run, std::size_t keep_every_nth, double max_range_m, double noise,
                 RandomDraws& draws) {
  TrueRun kept;
  std::optional<TPose2D> last;
  TPose2D odom_T_robot(0, 0, 0);
  for (std::size_t i = 0; i < run.frames.size(); i += keep_every_nth) {
    Frame frame = run.frames[i];
    const TPose2D step = last ? frame.odom_T_robot - *last : TPose2D(0, 0, 0);
    last = frame.odom_T_robot;
    const double root_m = std::sqrt(std::hypot(step.x, step.y));
    const double turn_rad = noise * 0.02 * root_m * draws.normal();
    const double along_m = noise * 0.03 * root_m * draws.normal();
    odom_T_robot = odom_T_robot + TPose2D(step.x + along_m, step.y, step.phi + turn_rad);
    frame.odom_T_robot = odom_T_robot;
    frame.index = kept.frames.size();
    for (float& range_m : frame.scan.ranges_m)
      if (range_m > static_cast<float>(max_range_m)) range_m = std::numeric_limits<float>::infinity();
    kept.frames.push_back(std::move(frame));
    kept.world_T_robot.push_back(run.world_T_robot[i]);
  }
  return kept;
}

/// Moves the odometry of all frames from `from` on by a slip.
void slip(TrueRun& run, std::size_t from, const TPose2D& slipped) {
  const TPose2D before = run.frames[from - 1].odom_T_robot;
  const TPose2D first = run.frames[from].odom_T_robot;
  const TPose2D jumped = before + (first - before) + slipped;
  for (std::size_t i = from; i < run.frames.size(); ++i)
    run.frames[i].odom_T_robot = jumped + (run.frames[i].odom_T_robot - first);
}

/// Index of the first frame that is `path_m` metres of true path after `from`.
std::size_t frame_after(const TrueRun& run, std::size_t from, double path_m) {
  double travelled_m = 0;
  std::size_t i = from;
  for (; i + 1 < run.frames.size() && travelled_m < path_m; ++i) {
    const TPose2D& a = run.world_T_robot[i];
    const TPose2D& b = run.world_T_robot[i + 1];
    travelled_m += std::hypot(b.x - a.x, b.y - a.y);
  }
  return i;
}

std::vector<TPose2D> poses_of(const std::vector<FrameRecord>& frames) {
  std::vector<TPose2D> poses;
  for (const FrameRecord& frame : frames) poses.push_back(frame.map_T_robot);
  return poses;
}

mrpt::math::TPoint2D place_of(const MappingResult& result, std::size_t frame) {
  const TPose2D& pose = result.frames[frame].map_T_robot;
  return {pose.x, pose.y};
}

FaultyMap faulty_map(MapFault fault, std::uint64_t seed, MappingResult result, const TrueRun& run) {
  FaultyMap map{fault, seed, std::move(result), 0, {}};
  map.error_m = aligned_error_m(poses_of(map.result.frames), run.world_T_robot);
  return map;
}

/// Records constraint `index` of the graph as an accepted loop of the result.
void record_loop(std::size_t index, MappingResult& result) {
  const Constraint& constraint = result.graph.constraint(index);
  LoopRecord loop;
  loop.node = constraint.to;
  loop.frame = result.node_frames[loop.node];
  loop.anchor = constraint.from;
  const auto map = std::find_if(result.local_maps.begin(), result.local_maps.end(),
                                [&](const LocalMapRecord& one) { return one.anchor == loop.anchor; });
  if (map != result.local_maps.end())
    loop.local_map = static_cast<std::size_t>(map - result.local_maps.begin());
  loop.anchor_T_node = constraint.from_T_to;
  loop.covariance = constraint.information.inverse();
  loop.verdict = LoopVerdict::kAccepted;
  result.loops.push_back(loop);
}

/// Keeps only every nth accepted loop, so that a false loop is not outvoted at once.
void keep_few_loops(std::size_t nth, MappingResult& result) {
  std::set<std::pair<std::size_t, std::size_t>> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < result.graph.num_constraints(); ++i) {
    const Constraint& loop = result.graph.constraint(i);
    if (loop.kind != Constraint::Kind::kLoop || !result.graph.enabled(i)) continue;
    if (count++ % nth == 0)
      kept.emplace(loop.from, loop.to);
    else
      result.graph.set_enabled(i, false);
  }
  const auto is_dropped = [&](const LoopRecord& loop) {
    return loop.verdict != LoopVerdict::kAccepted || kept.count({loop.anchor, loop.node}) == 0;
  };
  result.loops.erase(std::remove_if(result.loops.begin(), result.loops.end(), is_dropped),
                     result.loops.end());
}

/// Adds false loops with full weight and optimises the graph without a defence against outlier loops.
FaultyMap with_false_loops(MapFault fault, std::uint64_t seed, MappingResult result, const TrueRun& run) {
  FalseLoopOptions options;
  options.seed = seed;
  options.kind = fault == MapFault::kLoopGroup    ? FalseLoopKind::kGroups
                 : fault == MapFault::kNearbyLoop ? FalseLoopKind::kNearby
                                                  : FalseLoopKind::kScattered;
  options.count = fault == MapFault::kLoopGroup ? 5 : 1;
  keep_few_loops(kLoopsKept, result);
  const std::vector<std::size_t> added = add_false_loops(result.graph, result.graph.poses(), options);
  PoseAdjustmentOptions solver;
  solver.loop_kernel.type = RobustKernel::Type::kNone;
  SparsePoseAdjustment(solver).optimize(result.graph);
  carry_frames_along(result.graph.poses(), result.node_frames, result.frames);
  for (const std::size_t index : added) record_loop(index, result);
  FaultyMap map = faulty_map(fault, seed, std::move(result), run);
  for (const std::size_t index : added) {
    const Constraint& loop = map.result.graph.constraint(index);
    map.places.push_back(place_of(map.result, map.result.node_frames[loop.from]));
    map.places.push_back(place_of(map.result, map.result.node_frames[loop.to]));
  }
  return map;
}

FaultyMap with_slip(std::uint64_t seed, TrueRun run, RandomDraws& draws) {
  const auto from =
      static_cast<std::size_t>((0.3 + 0.4 * draws.share()) * static_cast<double>(run.frames.size()));
  const std::size_t to = frame_after(run, from, 2.5);
  for (std::size_t i = from; i < to; ++i)
    for (float& range_m : run.frames[i].scan.ranges_m) range_m = std::numeric_limits<float>::infinity();
  const double side = draws.share() < 0.5 ? -1 : 1;
  const double slip_m = 0.3 + 0.5 * draws.share();
  const double slip_rad = side * (0.1 + 0.15 * draws.share());
  slip(run, (from + to) / 2, {slip_m, 0, slip_rad});
  FaultyMap map = faulty_map(MapFault::kSlip, seed, map_of(run.frames, false), run);
  for (std::size_t i = from - 1; i <= to; ++i) map.places.push_back(place_of(map.result, i));
  return map;
}

FaultyMap with_robot_carried(std::uint64_t seed, TrueRun run, RandomDraws& draws) {
  const auto off =
      static_cast<std::size_t>((0.35 + 0.2 * draws.share()) * static_cast<double>(run.frames.size()));
  const std::size_t on = frame_after(run, off, 8 + 10 * draws.share());
  const TPose2D odom_T_off = run.frames[off - 1].odom_T_robot;
  const TPose2D odom_T_on = run.frames[on].odom_T_robot;
  for (std::size_t i = on; i < run.frames.size(); ++i)
    run.frames[i].odom_T_robot = odom_T_off + (run.frames[i].odom_T_robot - odom_T_on);
  const auto at = [](auto& all, std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  run.frames.erase(at(run.frames, off), at(run.frames, on));
  run.world_T_robot.erase(at(run.world_T_robot, off), at(run.world_T_robot, on));
  for (std::size_t i = 0; i < run.frames.size(); ++i) run.frames[i].index = i;
  FaultyMap map = faulty_map(MapFault::kCarried, seed, map_of(run.frames), run);
  map.places = {place_of(map.result, off - 1), place_of(map.result, off)};
  return map;
}

}  // namespace

std::string name_of(MapFault fault) {
  constexpr std::array<const char*, kMapFaults.size()> kNames{
      "none", "false loop", "nearby loop", "loop group", "no loops", "slip", "carried", "thinned"};
  return kNames[static_cast<std::size_t>(fault)];
}

bool has_one_place(MapFault fault) {
  return fault != MapFault::kNone && fault != MapFault::kNoLoops && fault != MapFault::kThinned;
}

double aligned_error_m(const std::vector<TPose2D>& path, const std::vector<TPose2D>& truth) {
  const auto count = static_cast<double>(path.size());
  mrpt::math::TPoint2D path_mean(0, 0);
  mrpt::math::TPoint2D true_mean(0, 0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    path_mean += mrpt::math::TPoint2D(path[i].x, path[i].y) * (1 / count);
    true_mean += mrpt::math::TPoint2D(truth[i].x, truth[i].y) * (1 / count);
  }
  double dot = 0;
  double cross = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double px = path[i].x - path_mean.x;
    const double py = path[i].y - path_mean.y;
    const double tx = truth[i].x - true_mean.x;
    const double ty = truth[i].y - true_mean.y;
    dot += px * tx + py * ty;
    cross += px * ty - py * tx;
  }
  const TPose2D turn(0, 0, std::atan2(cross, dot));
  double sum_m = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TPose2D turned = turn + TPose2D(path[i].x - path_mean.x, path[i].y - path_mean.y, 0);
    sum_m += std::hypot(turned.x - (truth[i].x - true_mean.x), turned.y - (truth[i].y - true_mean.y));
  }
  return sum_m / count;
}

void make_faulty_maps(std::uint64_t seed, double path_m, const std::function<void(FaultyMap&&)>& take) {
  RandomDraws draws(seed, "verdict", 0);
  const TrueRun run = simulated_run(seed, path_m, draws);
  const MappingResult plain = map_of(run.frames);
  for (const MapFault fault : {MapFault::kFalseLoop, MapFault::kNearbyLoop, MapFault::kLoopGroup})
    take(with_false_loops(fault, seed, plain, run));
  take(faulty_map(MapFault::kNone, seed, plain, run));
  const double noise = 1 + 3 * draws.share();
  const double poor_range_m = 4 + 4 * draws.share();
  const std::size_t poor_nth = 2 + draws.index(4);
  const TrueRun poor = degraded(run, poor_nth, poor_range_m, noise, draws);
  take(faulty_map(MapFault::kNoLoops, seed, map_of(poor.frames, false), poor));
  take(with_slip(seed, run, draws));
  take(with_robot_carried(seed, run, draws));
  const std::size_t thinned_nth = 4 + draws.index(8);
  const TrueRun thinned = degraded(run, thinned_nth, 8, noise, draws);
  take(faulty_map(MapFault::kThinned, seed, map_of(thinned.frames), thinned));
}

}  // namespace psi_slam
