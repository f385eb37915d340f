// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_benchmark.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "loop_closure/outlier_loops.h"
#include "mapping/carried_frames.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kWorstFirstOnly = 1;  // doubtful share that switches off only the worst loops

std::vector<std::size_t> loops_on(const PoseGraph& graph) {
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i)
    if (graph.enabled(i) && graph.constraint(i).kind == Constraint::Kind::kLoop) loops.push_back(i);
  return loops;
}

/// The graph of the trial with false loops, for several treatments.
class SpoiltGraph {
 public:
  SpoiltGraph(const LoopTrial& trial, const FalseLoopOptions& options)
      : trial_(trial), graph_(trial.graph), true_loops_(loops_on(graph_)) {
    false_loops_ = add_false_loops(graph_, trial.graph.poses(), options);
  }

  std::size_t true_loops() const { return true_loops_.size(); }
  std::size_t false_loops() const { return false_loops_.size(); }

  template <class Settle>
  LoopTrialOutcome settled(const std::vector<TPose2D>& start, const Settle& settle) const {
    PoseGraph graph = graph_;
    for (std::size_t node = 0; node < start.size(); ++node) graph.set_pose(node, start[node]);
    std::vector<std::size_t> loops = true_loops_;
    loops.insert(loops.end(), false_loops_.begin(), false_loops_.end());
    SparsePoseAdjustment solver(trial_.solver);
    const auto began = std::chrono::steady_clock::now();
    settle(graph, solver, loops);
    LoopTrialOutcome outcome;
    outcome.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
    outcome.error = trial_.error(graph.poses());
    for (const std::size_t loop : false_loops_) outcome.false_kept += graph.enabled(loop) ? 1 : 0;
    for (const std::size_t loop : true_loops_) outcome.true_lost += graph.enabled(loop) ? 0 : 1;
    return outcome;
  }

 private:
  const LoopTrial& trial_;
  PoseGraph graph_;
  std::vector<std::size_t> true_loops_;
  std::vector<std::size_t> false_loops_;
};

LoopTrial trial_of(const MappedRun& run, const MapperOptions& options,
                   const std::vector<Relation>& relations) {
  LoopTrial trial;
  trial.graph = run.graph;
  for (const std::size_t frame : run.result.node_frames)
    trial.unlooped.push_back(run.result.frames[frame].front_end_T_robot);
  trial.max_chi = options.back_end.max_loop_chi;
  trial.solver = options.pose_graph;
  trial.error = [&run, &relations](const std::vector<TPose2D>& map_T_node) {
    std::vector<FrameRecord> frames = run.result.frames;
    carry_frames_along(map_T_node, run.result.node_frames, frames);
    const RelationsMetric metric = error_of(frames, relations);
    return LoopTrial::Error{metric.translation_abs_m.mean, metric.rotation_abs_deg.mean};
  };
  return trial;
}

}  // namespace

FalseLoopRow run_loop_trial(const LoopTrial& trial, FalseLoopKind kind, double share_percent,
                            std::uint64_t seed) {
  FalseLoopOptions options;
  options.kind = kind;
  options.seed = seed;
  options.count = static_cast<std::size_t>(
      std::lround(share_percent / 100 * static_cast<double>(loops_on(trial.graph).size())));
  const SpoiltGraph spoilt(trial, options);
  const auto defend = [&](double doubtful_share) {
    return [&trial, doubtful_share](PoseGraph& graph, SparsePoseAdjustment& solver,
                                    const std::vector<std::size_t>& loops) {
      switch_off_outlier_loops(graph, solver, loops, trial.max_chi, doubtful_share);
    };
  };
  const auto optimize_only = [](PoseGraph& graph, SparsePoseAdjustment& solver,
                                const std::vector<std::size_t>&) { solver.optimize(graph); };
  FalseLoopRow row;
  row.kind = kind;
  row.share_percent = share_percent;
  row.seed = seed;
  row.true_loops = spoilt.true_loops();
  row.false_loops = spoilt.false_loops();
  row.undefended = spoilt.settled(trial.unlooped, optimize_only);
  row.worst_first = spoilt.settled(trial.unlooped, defend(kWorstFirstOnly));
  row.defended = spoilt.settled(trial.unlooped, defend(kDoubtfulShare));
  row.from_map = spoilt.settled(trial.graph.poses(), defend(kDoubtfulShare));
  return row;
}

FalseLoopBenchmark run_false_loop_benchmark(const std::vector<BenchmarkLog>& logs,
                                            const FalseLoopBenchmarkOptions& options,
                                            const ProgressObserver& observer) {
  FalseLoopBenchmark benchmark;
  benchmark.identities = identities_of(logs);
  const auto trials =
      static_cast<double>(options.kinds.size() * options.shares_percent.size() * options.seeds.count());
  const double work = 2 * trials;  // of one log: mapping takes about as long as the trials
  const double all = work * static_cast<double>(logs.size());
  double done = 0;
  for (const BenchmarkLog& log : logs) {
    const Settings settings = benchmark_settings(log.ini);
    const std::vector<Relation> relations = read_relations(log.relations.value());
    const auto source = open_log(log.log, log_options(settings));
    MapperOptions mapper = mapper_options(settings);
    mapper.back_end.joint_refinement.rounds = 0;  // it would move the graph away from its optimum
    const MappedRun run = map_source(
        *source, mapper, [&](double share) { observer("mapping " + log.name, done + trials * share, all); });
    done += trials;
    const LoopTrial trial = trial_of(run, settings.mapper, relations);
    benchmark.logs.push_back({log.name, trial.graph.num_nodes(), loops_on(trial.graph).size(),
                              trial.error(trial.graph.poses()), trial.error(trial.unlooped)});
    for (const FalseLoopKind kind : options.kinds) {
      for (const double share_percent : options.shares_percent) {
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
