// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <mrpt/system/md5.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <map>

#include "base/number_text.h"
#include "loop_closure/loop_verification.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

const std::size_t kUsualNodesPerLocalMap = FrontEndOptions().nodes_per_local_map;
constexpr std::size_t kFewerCases = 5;  // series over sizes draw a fifth of the cases

std::string md5_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return mrpt::system::md5(std::string(std::istreambuf_iterator<char>(file), {}));
}

MatchSeries make_series(std::string title, const MatchBenchmarkOptions& options) {
  MatchSeries series;
  series.title = std::move(title);
  series.cases.count = options.cases;
  series.cases.seed = options.seed;
  return series;
}

MatchBenchmark plan(const MatchBenchmarkOptions& options) {
  MatchBenchmark benchmark;
  benchmark.scans = make_series("Single scans", options);
  benchmark.contexts = make_series("Scans with their context", options);
  benchmark.contexts.cases.context = true;
  if (!options.windows) return benchmark;
  MatchBenchmarkOptions fewer = options;
  fewer.cases = std::max<std::size_t>(1, options.cases / kFewerCases);
  for (const double window_m : {2.0, 4.0, 8.0, 16.0}) {
    MatchSeries series = make_series("±" + fixed_text(window_m, 0) + " m", fewer);
    // The same distance for windows of all sizes, so that all have the same negative pairs.
    series.cases.clear_m += series.cases.window_m - window_m;
    series.cases.window_m = window_m;
    series.set = CandidateSet::kMatchers;
    benchmark.windows.push_back(std::move(series));
  }
  for (const std::size_t nodes :
       {kUsualNodesPerLocalMap / 2, kUsualNodesPerLocalMap, 2 * kUsualNodesPerLocalMap}) {
    MatchSeries series = make_series(std::to_string(nodes) + " nodes", fewer);
    series.nodes_per_local_map = nodes;
    series.set = CandidateSet::kMatchers;
    benchmark.local_maps.push_back(std::move(series));
  }
  return benchmark;
}

/// All series by the size of their local maps: a log is mapped once for each size.
std::map<std::size_t, std::vector<MatchSeries*>> series_by_nodes(MatchBenchmark& benchmark) {
  std::map<std::size_t, std::vector<MatchSeries*>> result;
  const auto add = [&result](MatchSeries& series) { result[series.nodes_per_local_map].push_back(&series); };
  add(benchmark.scans);
  add(benchmark.contexts);
  for (MatchSeries& series : benchmark.windows) add(series);
  for (MatchSeries& series : benchmark.local_maps) add(series);
  return result;
}

double accepted_response(const CaseOptions& cases, const LoopVerificationOptions& verification) {
  return cases.context ? verification.min_context_response : verification.min_response;
}

struct CaseCounts {
  std::size_t positive = 0;
  std::size_t negative = 0;
};

CaseCounts count(const std::vector<LoopCase>& cases) {
  CaseCounts counts;
  for (const LoopCase& loop_case : cases) ++(loop_case.positive ? counts.positive : counts.negative);
  return counts;
}

/// The cases that the log lacks, as a clause; may be empty.
std::string missing_cases(const CaseCounts& counts, const MatchSeries& series) {
  const auto missing = [&](std::size_t got, const char* kind) {
    if (got >= series.cases.count) return std::string();
    return std::to_string(got) + " of " + std::to_string(series.cases.count) + ' ' + kind + " cases";
  };
  const std::string positive = missing(counts.positive, "positive");
  const std::string negative = missing(counts.negative, "negative");
  if (positive.empty() && negative.empty()) return {};
  return series.title + ": the log has only " + positive +
         (positive.empty() || negative.empty() ? "" : " and ") + negative;
}

void add_remark(LogNote& note, const std::string& remark) {
  note.remark += (note.remark.empty() ? "" : "; ") + remark;
}

/// Runs the benchmark log by log. Progress counts matches: mapping takes much less time.
class BenchmarkRun {
 public:
  BenchmarkRun(const MatchBenchmarkOptions& options, std::size_t logs, const ProgressObserver& observer)
      : observer_(observer), benchmark_(plan(options)), by_nodes_(series_by_nodes(benchmark_)) {
    for (const auto& [nodes, all_series] : by_nodes_) all_ += static_cast<double>(logs) * planned(all_series);
  }

  void run(const BenchmarkLog& log) {
    LogNote& note = benchmark_.logs.emplace_back();
    note.name = log.name;
    note.md5 = md5_of(log.log);
    note.used = log.relations.has_value();
    if (!note.used) add_remark(note, "left out: it has no relations to check its map");
    for (const auto& [nodes, all_series] : by_nodes_) {
      if (note.used) run(log, nodes, all_series, note);
      done_ += planned(all_series);
    }
  }

  MatchBenchmark take_result() { return std::move(benchmark_); }

 private:
  using AllSeries = std::vector<MatchSeries*>;

  static double planned(const AllSeries& all_series) {
    double matches = 0;
    for (const MatchSeries* series : all_series)
      matches += 2 * static_cast<double>(series->cases.count) *
                 static_cast<double>(match_candidates(series->set, MapperOptions()).size());
    return matches;
  }

  void run(const BenchmarkLog& log, std::size_t nodes, const AllSeries& all_series, LogNote& note) {
    const bool usual = nodes == kUsualNodesPerLocalMap;
    const std::string of_maps = usual ? "" : " with local maps of " + std::to_string(nodes) + " nodes";
    const MappedLog mapped = map_log(log, nodes, [&](double share) {
      observer_("mapping " + log.name + of_maps + ' ' + fixed_text(100 * share, 0) + " %, in all", done_,
                all_);
    });
    if (usual) note.translation_error_m = mapped.translation_error_m;
    if (mapped.translation_error_m > kTrustedError_m) {
      if (usual) note.used = false;
      add_remark(note, "left out" + of_maps + ": the error of its map over the true relations, " +
                           fixed_text(mapped.translation_error_m, 3) + " m, is too large for a truth");
      return;
    }
    double matches = 0;
    for (MatchSeries* series : all_series) {
      const std::vector<LoopCase> cases = draw_cases(mapped, series->cases);
      const CaseCounts counts = count(cases);
      if (series == &benchmark_.scans) {
        note.positive = counts.positive;
        note.negative = counts.negative;
      }
      const std::string missing = missing_cases(counts, *series);
      if (!missing.empty()) add_remark(note, missing);
      const std::vector<MatchCandidate> all_candidates = match_candidates(series->set, mapped.options);
      run_cases(cases, all_candidates,
                accepted_response(series->cases, mapped.options.back_end.loop_closure.verification), *series,
                [&] {
                  matches += static_cast<double>(all_candidates.size());
                  observer_(log.name + ", " + series->title, done_ + matches, all_);
                });
    }
  }

  const ProgressObserver& observer_;
  MatchBenchmark benchmark_;
  const std::map<std::size_t, AllSeries> by_nodes_;
  double done_ = 0;
  double all_ = 0;
};

}  // namespace

void run_cases(const std::vector<LoopCase>& cases, const std::vector<MatchCandidate>& candidates,
               double accepted_response, MatchSeries& series, const std::function<void()>& after_case) {
  if (series.rows.empty())
    for (const MatchCandidate& candidate : candidates) series.rows.push_back({candidate.name(), {}});
  std::vector<MatchResult> matches(candidates.size());
  std::vector<double> times_ms(candidates.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const LoopCase& loop_case = cases[i];
    MatchProblem problem{loop_case.map->scores(),
                         *loop_case.scan,
                         loop_case.start,
                         {series.cases.window_m, series.cases.window_m, series.cases.window_rad}};
    problem.min_response = kReportedShare * accepted_response;
    problem.measure_ambiguity = true;
    problem.seed = loop_case.seed;
    // Each case starts with another candidate, so that cache misses hit all candidates alike.
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const std::size_t at = (i + k) % candidates.size();
      const Matcher& matcher = candidates[at].matcher(loop_case);
      const auto start = std::chrono::steady_clock::now();
      matches[at] = matcher.match(problem);
      times_ms[at] =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    for (std::size_t k = 0; k < candidates.size(); ++k)
      series.rows[k].tally.add(loop_case, judge(loop_case, matches[k], matches.front(), accepted_response),
                               matches[k], times_ms[k]);
    after_case();
  }
}

MatchBenchmark run_match_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const MatchBenchmarkOptions& options, const ProgressObserver& observer) {
  BenchmarkRun run(options, logs.size(), observer);
  for (const BenchmarkLog& log : logs) run.run(log);
  MatchBenchmark benchmark = run.take_result();
  if (std::none_of(benchmark.logs.begin(), benchmark.logs.end(), [](const LogNote& log) { return log.used; }))
    throw UserError("no log can be used: " + benchmark.logs.front().name + " was " +
                    benchmark.logs.front().remark);
  return benchmark;
}

}  // namespace psi_slam
