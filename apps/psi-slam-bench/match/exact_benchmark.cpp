// SPDX-License-Identifier: BSD-3-Clause
#include "match/exact_benchmark.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/number_text.h"
#include "common/processor_time.h"
#include "match/depth_first_search.h"
#include "matching/make_matcher.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kThresholds[] = {0.4, 0.5, 0};

void add_time(SearchTimes& times, double time_ms, double share) {
  times.mean_ms += share * time_ms;
  times.max_ms = std::max(times.max_ms, time_ms);
}

MatchProblem problem_of(const LoopCase& loop_case, const CaseOptions& options, double min_response) {
  MatchProblem problem{loop_case.map->scores(),
                       *loop_case.scan,
                       loop_case.start,
                       {options.window_m, options.window_m, options.window_rad}};
  problem.min_response = min_response;
  return problem;
}

bool equal(const MatchResult& match, const SearchLattice& lattice, const DepthFirstOutcome& reference) {
  if (!match.found || !reference.best) return !match.found && !reference.best;
  const mrpt::math::TPose2D pose = lattice.pose(reference.best->pose);
  return match.response == lattice.response(reference.best->sum) && match.lattice_pose.x == pose.x &&
         match.lattice_pose.y == pose.y && match.lattice_pose.phi == pose.phi;
}

}  // namespace

ExactBenchmarkRow search_exactly(const std::vector<LoopCase>& cases, const CaseOptions& options,
                                 const MapperOptions& mapper, double min_response, std::size_t repeats) {
  const CorrelativeMatcher matcher(mapper.back_end.loop_matcher);
  ExactBenchmarkRow row;
  row.min_response = min_response;
  row.count = cases.size();
  const double share = 1 / static_cast<double>(cases.size());
  for (const LoopCase& loop_case : cases) {
    MatchProblem problem = problem_of(loop_case, options, min_response);
    MatchResult match;
    add_time(row.csm, least_ms(repeats, [&] { match = matcher.match(problem); }), share);
    problem.measure_ambiguity = true;
    add_time(row.csm_ambiguity, least_ms(repeats, [&] { matcher.match(problem); }), share);

    const MaximumGrids grids(problem.grid);
    DepthFirstOutcome reference;
    add_time(row.depth_first,
             least_ms(repeats,
                      [&] {
                        const SearchLattice lattice(problem.grid, problem.scan, problem.map_T_robot,
                                                    match.window);
                        const double least = std::ceil(min_response * lattice.goal_max());
                        reference = depth_first_search(lattice, grids, static_cast<std::uint32_t>(least));
                      }),
             share);
    const SearchLattice lattice(problem.grid, problem.scan, problem.map_T_robot, match.window);
    row.found += match.found ? 1 : 0;
    row.equal += equal(match, lattice, reference) ? 1 : 0;
    row.csm_evaluations += share * static_cast<double>(match.evaluations);
    row.depth_first_evaluations += share * static_cast<double>(reference.evaluations);
  }
  return row;
}

ExactBenchmark run_exact_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const ExactBenchmarkOptions& options, const ProgressObserver& observer) {
  ExactBenchmark benchmark;
  benchmark.logs = identities_of(logs);
  CaseOptions how;
  how.count = options.cases;
  how.seed = options.seed;
  std::vector<LoopCase> positive;
  std::vector<LoopCase> negative;
  MapperOptions mapper;
  for (const BenchmarkLog& log : logs) {
    const MappedLog mapped = map_log(log, [&](double share) {
      observer("mapping " + log.name + ' ' + fixed_text(100 * share, 0) + " %, in all", 0, 1);
    });
    mapper = mapped.options;
    for (const LoopCase& one : draw_cases(mapped, how)) (one.positive ? positive : negative).push_back(one);
  }
  if (positive.empty() && negative.empty())
    throw UserError("no scan and local map of the logs suit a case: expected a path of more than 10 m");
  double done = 0;
  for (const double threshold : kThresholds) {
    for (const auto& [name, cases] : {std::pair("loop", &positive), std::pair("no loop", &negative)}) {
      if (cases->empty()) continue;
      observer("threshold " + fixed_text(threshold, 1) + ", " + name, done, 2 * std::size(kThresholds));
      benchmark.rows.push_back(search_exactly(*cases, how, mapper, threshold, options.repeats));
      benchmark.rows.back().cases = name;
      ++done;
    }
  }
  const std::vector<LoopCase>& any = positive.empty() ? negative : positive;
  for (const LoopCase& one : any)
    benchmark.maximum_grids_ms +=
        least_ms(options.repeats, [&] { const MaximumGrids grids(one.map->scores()); }) /
        static_cast<double>(any.size());
  return benchmark;
}

}  // namespace psi_slam
