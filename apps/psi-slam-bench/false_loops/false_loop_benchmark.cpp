// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_benchmark.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "base/portable_math.h"
#include "base/random_draws.h"
#include "false_loops/bent_path.h"
#include "logs/frames/pose_operations.h"
#include "mapping/carried_frames.h"
#include "mapping/loop_closure/outlier_loops.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Material {
  std::vector<std::size_t> references;  ///< nodes where loops may begin: first nodes of path segments
  std::vector<Constraint> loops;        ///< enabled loops
};

Material material_of(const PoseGraph& graph) {
  Material material;
  std::set<std::size_t> references;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& constraint = graph.constraint(i);
    if (constraint.kind == Constraint::Kind::kLocalMap) references.insert(constraint.from);
    if (constraint.kind != Constraint::Kind::kLoop || !graph.enabled(i)) continue;
    references.insert(constraint.from);
    material.loops.push_back(constraint);
  }
  material.references.assign(references.begin(), references.end());
  return material;
}

TPose2D draw_place(double reach_m, RandomDraws& draws) {
  const double radius_m = reach_m * std::sqrt(draws.share());
  const double direction = draws.plus_minus(M_PI);
  return {radius_m * portable::cos(direction), radius_m * portable::sin(direction), draws.plus_minus(M_PI)};
}

bool is_false(const TPose2D& place, const TPose2D& truth, const FalseLoopOptions& options) {
  TPose2D error = between(truth, place);
  error.normalizePhi();
  return portable::hypot(error.x, error.y) >= options.min_error_m ||
         std::abs(error.phi) >= options.min_error_rad;
}

/// Draws loops that join one node, or a group of successive nodes, to one random pose near a random
/// reference.
std::vector<Constraint> draw_elsewhere(const Material& material, const std::vector<TPose2D>& map_T_node,
                                       const FalseLoopOptions& options, RandomDraws& draws) {
  std::size_t group = 1;
  if (options.kind == FalseLoopKind::kGroups)
    group = options.smallest_group + draws.index(options.largest_group - options.smallest_group + 1);
  const std::size_t first = draws.index(map_T_node.size());
  const std::size_t last = std::min(first + group, map_T_node.size());
  const std::size_t reference = material.references[draws.index(material.references.size())];
  const TPose2D place = draw_place(options.reach_m, draws);
  std::vector<Constraint> loops;
  for (std::size_t node = first; node < last; ++node) {
    Constraint loop;
    loop.from = reference;
    loop.to = node;
    loop.from_T_to = compose(place, between(map_T_node[first], map_T_node[node]));
    loop.information = material.loops[draws.index(material.loops.size())].information;
    loops.push_back(loop);
  }
  return loops;
}

Constraint draw_nearby(const Material& material, const FalseLoopOptions& options, RandomDraws& draws) {
  Constraint loop = material.loops[draws.index(material.loops.size())];
  const double off_m = options.min_error_m + draws.share() * (options.nearby_m - options.min_error_m);
  const double direction = draws.plus_minus(M_PI);
  loop.from_T_to =
      compose(loop.from_T_to, TPose2D(off_m * portable::cos(direction), off_m * portable::sin(direction),
                                      draws.plus_minus(options.min_error_rad)));
  return loop;
}

std::vector<std::size_t> loops_on(const PoseGraph& graph) {
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i)
    if (graph.enabled(i) && graph.constraint(i).kind == Constraint::Kind::kLoop) loops.push_back(i);
  return loops;
}

LoopTrial trial_of(const MappingResult& run, const MapperOptions& options,
                   const std::vector<Relation>& relations) {
  LoopTrial trial;
  trial.graph = run.graph;
  for (const std::size_t frame : run.node_frames)
    trial.unlooped.push_back(run.frames[frame].front_end_T_robot);
  trial.solver = options.pose_graph;
  trial.error = [&run, &relations](const std::vector<TPose2D>& map_T_node) {
    std::vector<FrameRecord> frames = run.frames;
    carry_frames_along(map_T_node, run.node_frames, frames);
    const RelationsMetric metric = error_of(frames, relations);
    return LoopTrial::Error{metric.translation_abs_m.mean, metric.rotation_abs_deg.mean};
  };
  return trial;
}

}  // namespace

std::string name_of(FalseLoopKind kind) {
  constexpr std::array<const char*, 4> kNames{"scattered", "groups", "nearby", "slips"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<std::size_t> add_false_loops(PoseGraph& graph, const std::vector<TPose2D>& map_T_node,
                                         const FalseLoopOptions& options) {
  const Material material = material_of(graph);
  std::vector<std::size_t> added;
  if (material.loops.empty()) return added;
  RandomDraws draws(options.seed, name_of(options.kind), 0);
  while (added.size() < options.count) {
    std::vector<Constraint> loops = options.kind == FalseLoopKind::kNearby
                                        ? std::vector<Constraint>{draw_nearby(material, options, draws)}
                                        : draw_elsewhere(material, map_T_node, options, draws);
    for (Constraint& loop : loops) {
      loop.from_T_to.normalizePhi();
      loop.kind = Constraint::Kind::kLoop;
      const bool wrong =
          loop.from != loop.to &&
          is_false(loop.from_T_to, between(map_T_node[loop.from], map_T_node[loop.to]), options);
      if (wrong && added.size() < options.count) added.push_back(graph.add_constraint(loop));
    }
  }
  return added;
}

FalseLoopRow run_loop_trial(const LoopTrial& trial, FalseLoopKind kind, double share_percent,
                            std::uint64_t seed) {
  const std::vector<std::size_t> true_loops = loops_on(trial.graph);
  PoseGraph spoilt = trial.graph;
  std::vector<TPose2D> unlooped = trial.unlooped;
  std::vector<std::size_t> false_loops;
  FalseLoopRow row;
  if (kind == FalseLoopKind::kSlips) {
    BentPathOptions options;
    options.share = share_percent / 100;
    options.seed = seed;
    BentPath path = bent(trial.graph, trial.unlooped, options);
    spoilt = std::move(path.graph);
    unlooped = std::move(path.unlooped);
    row.false_loops = path.stretches;
  } else {
    FalseLoopOptions options;
    options.kind = kind;
    options.seed = seed;
    options.count =
        static_cast<std::size_t>(std::lround(share_percent / 100 * static_cast<double>(true_loops.size())));
    false_loops = add_false_loops(spoilt, trial.graph.poses(), options);
    row.false_loops = false_loops.size();
  }
  std::vector<std::size_t> loops = true_loops;
  loops.insert(loops.end(), false_loops.begin(), false_loops.end());

  const auto settled = [&](const std::vector<TPose2D>& start, const auto& settle) {
    PoseGraph graph = spoilt;
    for (std::size_t node = 0; node < start.size(); ++node) graph.set_pose(node, start[node]);
    SparsePoseAdjustment solver(trial.solver);
    const auto began = std::chrono::steady_clock::now();
    settle(graph, solver);
    LoopTrialOutcome outcome;
    outcome.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
    outcome.error = trial.error(graph.poses());
    for (const std::size_t loop : false_loops) outcome.false_kept += graph.enabled(loop) ? 1 : 0;
    for (const std::size_t loop : true_loops) outcome.true_lost += graph.enabled(loop) ? 0 : 1;
    return outcome;
  };
  const auto defended = [&](const std::vector<TPose2D>& start) {
    return settled(start, [&](PoseGraph& graph, SparsePoseAdjustment& solver) {
      reject_outlier_loops(graph, solver, loops);
    });
  };
  row.kind = kind;
  row.share_percent = share_percent;
  row.seed = seed;
  row.true_loops = true_loops.size();
  row.undefended = settled(unlooped, [](auto& graph, auto& solver) { solver.optimize(graph); });
  row.defended = defended(unlooped);
  row.from_map = defended(trial.graph.poses());
  return row;
}

FalseLoopBenchmark run_false_loop_benchmark(const std::vector<BenchmarkLog>& logs,
                                            const FalseLoopBenchmarkOptions& options,
                                            const ProgressObserver& observer) {
  FalseLoopBenchmark benchmark;
  benchmark.identities = identities_of(logs);
  const auto trials =
      static_cast<double>(options.kinds.size() * options.shares_percent.size() * options.seeds.count());
  const double work = 2 * trials;  // steps of one log: mapping takes about as long as all trials
  const double all = work * static_cast<double>(logs.size());
  double done = 0;
  for (const BenchmarkLog& log : logs) {
    const Settings settings = benchmark_settings(log.ini);
    const std::vector<Relation> relations = read_relations(log.relations.value());
    const auto source = open_log(log.log, log_options(settings));
    MapperOptions mapper = mapper_options(settings);
    mapper.back_end.joint_refinement.rounds = 0;  // refinement would move the graph away from its optimum
    const MappingResult run = map_source(
        *source, mapper, [&](double share) { observer("mapping " + log.name, done + trials * share, all); });
    done += trials;
    const LoopTrial trial = trial_of(run, settings.mapper, relations);
    benchmark.logs.push_back({log.name, trial.graph.num_nodes(), loops_on(trial.graph).size(),
                              trial.error(trial.graph.poses()), trial.error(trial.unlooped)});
    for (const FalseLoopKind kind : options.kinds) {
      for (const double share_percent : options.shares_percent) {
        if (kind == FalseLoopKind::kSlips && share_percent > 100) {
          done += static_cast<double>(options.seeds.count());
          continue;
        }
        for (const std::uint64_t seed : options.seeds.all()) {
          observer(log.name + ", " + name_of(kind), done, all);
          benchmark.rows.push_back(run_loop_trial(trial, kind, share_percent, seed));
          benchmark.rows.back().log = log.name;
          ++done;
        }
      }
    }
  }
  return benchmark;
}

}  // namespace psi_slam
