// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/faulty_maps.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/random_draws.h"
#include "common/aligned_error.h"
#include "false_loops/false_loop_benchmark.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/mapped_trajectory.h"
#include "mapping/carried_frames.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "verdict/known_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kLongestPath = 1.75;   // length of the longest path, in shortest paths
constexpr std::size_t kLoopsKept = 60;  // every nth true loop of a map with false loops is kept
constexpr double kBlind_m = 2.5;        // path on which the laser is blind while the wheels slip
constexpr double kPause_s = 60;

mrpt::math::TPoint2D place_of(const MappingResult& result, std::size_t frame) {
  const TPose2D& pose = result.frames[frame].map_T_robot;
  return {pose.x, pose.y};
}

FaultyMap faulty_map(MapFault fault, std::uint64_t seed, MappingResult result, const KnownRun& run) {
  const double error_m = mean_error_m(result, run);
  const double distance_m = aligned_error_m(mapped_poses(result), run.world_T_robot);
  return {run.log, fault, seed, std::move(result), error_m, distance_m, {}};
}

/// Frame at a random share of the run, from `least` to `least + more`.
std::size_t random_frame(const KnownRun& run, double least, double more, RandomDraws& draws) {
  return static_cast<std::size_t>((least + more * draws.share()) * static_cast<double>(run.frames.size()));
}

/// Records constraint `index` of the graph as an accepted loop of the result.
void record_loop(std::size_t index, MappingResult& result) {
  const Constraint& constraint = result.graph.constraint(index);
  LoopRecord loop;
  loop.node = constraint.to;
  loop.frame = result.node_frames[loop.node];
  loop.reference = loop.anchor = constraint.from;
  loop.reference_T_node = loop.anchor_T_node = constraint.from_T_to;
  const auto map =
      std::find_if(result.local_maps.begin(), result.local_maps.end(), [&](const LocalMapRecord& one) {
        return one.first_node <= loop.reference && loop.reference <= one.last_node;
      });
  loop.covariance = constraint.information.inverse();
  if (map != result.local_maps.end()) {
    loop.local_map = static_cast<std::size_t>(map - result.local_maps.begin());
    loop.anchor = map->anchor;
    const TPose2D anchor_T_reference =
        between(result.graph.pose(loop.anchor), result.graph.pose(loop.reference));
    loop.anchor_T_node = compose(anchor_T_reference, constraint.from_T_to);
    loop.covariance = in_turned_axes(loop.covariance, anchor_T_reference.phi);
  }
  loop.state = LoopState::kAccepted;
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
    return loop.state != LoopState::kAccepted || kept.count({loop.reference, loop.node}) == 0;
  };
  result.loops.erase(std::remove_if(result.loops.begin(), result.loops.end(), is_dropped),
                     result.loops.end());
}

/// Adds false loops with full weight and optimises the graph without a defence against outlier loops.
FaultyMap with_false_loops(MapFault fault, std::uint64_t seed, MappingResult result, const KnownRun& run) {
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

FaultyMap with_slip(std::uint64_t seed, KnownRun run, RandomDraws& draws) {
  const std::size_t from = random_frame(run, 0.3, 0.4, draws);
  const std::size_t to = frame_after(run, from, kBlind_m);
  const double side = draws.share() < 0.5 ? -1 : 1;
  const double slip_m = 0.3 + 0.5 * draws.share();
  const double slip_rad = side * (0.1 + 0.15 * draws.share());
  slip(run, from, to, {slip_m, 0, slip_rad});
  FaultyMap map = faulty_map(MapFault::kSlip, seed, map_of(run, false), run);
  for (std::size_t i = from - 1; i <= to; ++i) map.places.push_back(place_of(map.result, i));
  return map;
}

FaultyMap with_robot_carried(std::uint64_t seed, KnownRun run, RandomDraws& draws) {
  const std::size_t off = random_frame(run, 0.35, 0.2, draws);
  carry(run, off, frame_after(run, off, 8 + 10 * draws.share()));
  FaultyMap map = faulty_map(MapFault::kCarried, seed, map_of(run), run);
  map.places = {place_of(map.result, off - 1), place_of(map.result, off)};
  return map;
}

FaultyMap with_pause(std::uint64_t seed, KnownRun run, RandomDraws& draws) {
  const std::size_t at = random_frame(run, 0.3, 0.4, draws);
  pause(run, at, kPause_s);
  return faulty_map(MapFault::kPaused, seed, map_of(run), run);
}

/// Makes a map with each fault of the run `run`, whose map is `plain`.
void make_faults(std::uint64_t seed, const KnownRun& run, const MappingResult& plain, RandomDraws& draws,
                 const std::function<void(FaultyMap&&)>& take) {
  for (const MapFault fault : {MapFault::kFalseLoop, MapFault::kNearbyLoop, MapFault::kLoopGroup})
    take(with_false_loops(fault, seed, plain, run));
  const double noise = 1 + 3 * draws.share();
  const double poor_range_m = 4 + 4 * draws.share();
  const std::size_t poor_nth = 2 + draws.index(4);
  const KnownRun poor = degraded(run, poor_nth, poor_range_m, noise, draws);
  take(faulty_map(MapFault::kNoLoops, seed, map_of(poor, false), poor));
  take(with_slip(seed, run, draws));
  take(with_robot_carried(seed, run, draws));
  const std::size_t thinned_nth = 4 + draws.index(8);
  const KnownRun thinned = degraded(run, thinned_nth, 8, noise, draws);
  take(faulty_map(MapFault::kThinned, seed, map_of(thinned), thinned));
  take(with_pause(seed, run, draws));
}

}  // namespace

std::string name_of(MapFault fault) {
  constexpr std::array<const char*, kMapFaults.size()> kNames{
      "none", "false loop", "nearby loop", "loop group", "no loops", "slip", "carried", "thinned", "paused"};
  return kNames[static_cast<std::size_t>(fault)];
}

bool is_false_loop(MapFault fault) {
  return fault == MapFault::kFalseLoop || fault == MapFault::kNearbyLoop || fault == MapFault::kLoopGroup;
}

bool has_one_place(MapFault fault) {
  return is_false_loop(fault) || fault == MapFault::kSlip || fault == MapFault::kCarried;
}

void make_simulated_maps(std::uint64_t seed, double path_m, const std::function<void(FaultyMap&&)>& take) {
  RandomDraws draws(seed, "verdict", 0);
  const double longer = 1 + draws.share() * (kLongestPath - 1);
  const KnownRun run = simulated_run(seed, path_m * longer, draws);
  const MappingResult plain = map_of(run);
  take(faulty_map(MapFault::kNone, seed, plain, run));
  make_faults(seed, run, plain, draws, take);
}

void make_maps_of_log(const BenchmarkLog& log, const SeedRange& seeds,
                      const std::function<void(FaultyMap&&)>& take) {
  const auto [run, plain] = run_of_log(log);
  take(faulty_map(MapFault::kNone, seeds.first, plain, run));
  for (const std::uint64_t seed : seeds.all()) {
    RandomDraws draws(seed, "verdict of " + log.name, 0);
    make_faults(seed, run, plain, draws, take);
  }
}

}  // namespace psi_slam
