// SPDX-License-Identifier: BSD-3-Clause
#include "match/exact_benchmark.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/random_draws.h"
#include "match/depth_first_search.h"
#include "matching/make_matcher.h"
#include "matching/sum_kernel.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kThresholds[] = {0.4, 0.5, 0};

/// Returns the least processor time of `repeats` calls of `work`, in milliseconds.
template <class Work>
double least_ms(std::size_t repeats, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < repeats; ++i) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

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

/// Measures how many scores the sum kernel adds in a nanosecond, for a scan of 160 points anywhere in a score
/// grid of 0.25 MB, as large as one of Intel.
double kernel_scores_per_ns(std::size_t repeats) {
  constexpr std::size_t kPoints = 160;
  constexpr int kHeight = 8;
  constexpr std::ptrdiff_t kRow = 500;
  constexpr std::size_t kCalls = 2000;
  const std::vector<std::uint8_t> cells(kRow * kRow, 1);
  RandomDraws draws(1, "kernel", 0);
  std::vector<std::int32_t> offsets;
  for (std::size_t i = 0; i < kPoints; ++i)
    offsets.push_back(static_cast<std::int32_t>(draws.index(cells.size() - kRow * (kHeight + 1))));
  std::vector<std::uint32_t> sums(kSumLanes * kHeight, 0);
  const double time_ms = least_ms(repeats, [&] {
    for (std::size_t call = 0; call < kCalls; ++call)
      sum_kernel()(cells.data(), kRow, offsets.data(), kPoints, kSumLanes, kHeight, sums.data(), kSumLanes);
  });
  return static_cast<double>(kCalls * kPoints * kSumLanes * kHeight) / (1e6 * time_ms);
}

}  // namespace

ExactBenchmarkRow search_exactly(const std::vector<LoopCase>& cases, const CaseOptions& options,
                                 const MapperOptions& mapper, double min_response, std::size_t repeats,
                                 double scores_per_ns) {
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
    row.csm_limit_ms += share * static_cast<double>(match.evaluations) *
                        static_cast<double>(problem.scan.points.size()) / (1e6 * scores_per_ns);
  }
  return row;
}

ExactBenchmark run_exact_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const ExactBenchmarkOptions& options, const ProgressObserver& observer) {
  ExactBenchmark benchmark;
  benchmark.logs = identities_of(logs);
  benchmark.scores_per_ns = kernel_scores_per_ns(options.repeats);
  CaseOptions how;
  how.count = options.cases;
  how.seed = options.seed;
  std::vector<LoopCase> positive;
  std::vector<LoopCase> negative;
  MapperOptions mapper;
  for (const BenchmarkLog& log : logs) {
    const MappedLog mapped = map_log(log, FrontEndOptions().nodes_per_local_map, [&](double share) {
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
      benchmark.rows.push_back(
          search_exactly(*cases, how, mapper, threshold, options.repeats, benchmark.scores_per_ns));
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
