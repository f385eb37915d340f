// SPDX-License-Identifier: BSD-3-Clause
#include "paper/paper_benchmark.h"

#include <algorithm>
#include <utility>

#include "map/exports/mapped_trajectory.h"
#include "map/trajectory/loop_judgement.h"
#include "psi_slam/open_log.h"
#include "sparse/node_costs.h"

namespace psi_slam {
namespace {

/// Settings that make the searches those of the paper: windows of fixed size, each with a single scan.
/// Whole local maps are searched only where the path is uncertain by more than such a window. Without a final
/// search and refinement, the map depends only on the loops found in time, and those of the last nodes.
const std::vector<std::string> kPaperSearch{
    "run.threads=1",
    "loop_closure.window_x_m=8",
    "loop_closure.window_y_m=8",
    "loop_closure.window_theta_deg=30",
    "loop_closure.min_window_m=8",
    "loop_closure.min_window_theta_deg=30",
    "verification.wide_window_m=8",
    "final_search.passes=0",
    "joint_refinement.rounds=0",
};

std::vector<std::string> with_paper_genetics(std::vector<std::string> assignments) {
  assignments.emplace_back("genetic.variant=paper");
  return assignments;
}

PaperRow row_of(const BenchmarkLog& log, const PaperCandidate& candidate, std::uint64_t seed) {
  const Settings settings = paper_settings(log, candidate, seed);
  const MeasuredMap map = map_measured(*open_log(log.log, log_options(settings)), mapper_options(settings));
  const MappingResult& result = map.result;
  const std::vector<Relation> relations = read_relations(log.relations.value());
  PaperRow row;
  row.log = log.name;
  row.matcher = candidate.name;
  row.figures = figures_of(map, trajectory_of(result.frames), relations);
  row.loops = loops_accepted(result);
  const LoopJudgement judgement = judge_loops(result, relations);
  row.loops_judged = judgement.judged.size();
  row.loops_false = judgement.false_ones.size();
  for (const auto& [kind, matcher] : result.loop_matchers) {
    row.windows += matcher.effort.attempts;
    for (std::size_t i = 0; i < row.searches.size(); ++i)
      row.searches[i] += matcher.effort.by_search[i].attempts;
  }
  row.period_ms = scan_period_ms(result.frames);
  row.times = back_end_times(result.frames, map.add_ms, row.period_ms);
  return row;
}

}  // namespace

const std::vector<PaperCandidate>& paper_candidates() {
  static const std::vector<PaperCandidate> kCandidates{
      {"csm", "exact search, as Karto searches", {"loop_closure.matcher=csm"}},
      {"ga_paper", "genetic search of the paper", with_paper_genetics({"loop_closure.matcher=ga"})},
      {"ga", "genetic search of psi-slam", {"loop_closure.matcher=ga"}},
      {"switch_paper", "switch by Ψ, with the genetic search of the paper",
       with_paper_genetics(paper_switch_settings())},
      {"switch", "switch by Ψ, with the genetic search of psi-slam", paper_switch_settings()}};
  return kCandidates;
}

std::vector<PaperCandidate> PaperOptions::candidates() const {
  std::vector<PaperCandidate> chosen;
  for (const PaperCandidate& candidate : paper_candidates())
    if (matchers.empty() || std::find(matchers.begin(), matchers.end(), candidate.name) != matchers.end())
      chosen.push_back(candidate);
  return chosen;
}

Settings paper_settings(const BenchmarkLog& log, const PaperCandidate& candidate, std::uint64_t seed) {
  std::vector<std::string> assignments = kPaperSearch;
  assignments.push_back("run.seed=" + std::to_string(seed));
  assignments.insert(assignments.end(), candidate.assignments.begin(), candidate.assignments.end());
  return benchmark_settings(log.ini, assignments);
}

double scan_period_ms(const std::vector<FrameRecord>& frames) {
  std::vector<double> periods_ms;
  for (std::size_t i = 1; i < frames.size(); ++i)
    periods_ms.push_back(1e3 * seconds(frames[i].time_us - frames[i - 1].time_us));
  return quantile(std::move(periods_ms), 0.5);
}

BackEndTimes back_end_times(const std::vector<FrameRecord>& frames, const std::vector<double>& add_ms,
                            double period_ms) {
  BackEndTimes times;
  std::vector<double> all_ms;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].searched_loops) continue;
    all_ms.push_back(std::min(frames[i].loop_closing_ms + frames[i].pose_graph_ms, add_ms.at(i)));
    times.deadline_misses += all_ms.back() > period_ms ? 1 : 0;
  }
  times.searches = all_ms.size();
  times.p50_ms = quantile(all_ms, 0.5);
  times.p99_ms = quantile(all_ms, 0.99);
  times.max_ms = quantile(all_ms, 1);
  return times;
}

PaperBenchmark run_paper_benchmark(const SparseLogs& logs, const PaperOptions& options,
                                   const ProgressObserver& observer) {
  PaperBenchmark benchmark;
  const std::vector<PaperCandidate> candidates = options.candidates();
  const auto all = static_cast<double>((logs.dense.size() + logs.sparse.size()) * candidates.size());
  for (const auto* some : {&logs.dense, &logs.sparse}) {
    for (LogIdentity& identity : identities_of(*some)) benchmark.identities.push_back(std::move(identity));
    for (const BenchmarkLog& log : *some)
      for (const PaperCandidate& candidate : candidates) {
        observer(log.name + ", " + candidate.name, static_cast<double>(benchmark.rows.size()), all);
        benchmark.rows.push_back(row_of(log, candidate, options.seed));
      }
  }
  benchmark.without_relations = logs.without_relations;
  return benchmark;
}

}  // namespace psi_slam
