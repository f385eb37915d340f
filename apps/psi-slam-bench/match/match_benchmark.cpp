// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <mrpt/system/md5.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "common/processor_time.h"
#include "logs/frames/pose_operations.h"
#include "matching/make_matcher.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

// Searches report matches down to this share of the accepted response.
constexpr double kReportedShare = 0.8;

std::optional<double> share(std::size_t part, std::size_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

/// The memetic genetic search with one of its steps switched off.
struct Ablation {
  const char* name;
  void (*apply)(MemeticGeneticOptions&);
};

constexpr Ablation kAblations[] = {
    {"ga without sparse search", [](MemeticGeneticOptions& options) { options.seed_coarse = false; }},
    {"ga without generations", [](MemeticGeneticOptions& options) { options.generations = 0; }},
    {"ga without crossover", [](MemeticGeneticOptions& options) { options.crossover_rate = 0; }},
    {"ga without elite", [](MemeticGeneticOptions& options) { options.elite = 0; }},
    {"ga without Gray code", [](MemeticGeneticOptions& options) { options.gray_code = false; }},
    {"ga without niches", [](MemeticGeneticOptions& options) { options.niches = false; }},
    {"ga without memory", [](MemeticGeneticOptions& options) { options.remember = false; }},
    {"ga without pooled fitness", [](MemeticGeneticOptions& options) { options.pooled_fitness = false; }},
    {"ga without descents", [](MemeticGeneticOptions& options) { options.descents = 0; }},
    {"ga without polish", [](MemeticGeneticOptions& options) { options.polished = 0; }},
    {"ga without early stop", [](MemeticGeneticOptions& options) { options.patience = 0; }},
};

const std::size_t kUsualNodesPerLocalMap = FrontEndOptions().nodes_per_local_map;
constexpr std::size_t kFewerCases = 5;  // series over window and map sizes draw a fifth of the cases

std::string md5_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return mrpt::system::md5(std::string(std::istreambuf_iterator<char>(file), {}));
}

MatchSeries make_series(std::string title, const MatchBenchmarkOptions& options,
                        CandidateSet set = CandidateSet::kAll) {
  MatchSeries series;
  series.set = set;
  series.title = std::move(title);
  series.cases.count = options.cases;
  series.cases.seed = options.seed;
  return series;
}

MatchBenchmarkOptions with_fewer_cases(MatchBenchmarkOptions options) {
  options.cases = std::max<std::size_t>(1, options.cases / kFewerCases);
  return options;
}

MatchBenchmark plan(const MatchBenchmarkOptions& options) {
  MatchBenchmark benchmark;
  benchmark.scans = make_series("Single scans", options);
  benchmark.contexts = make_series("Scans with their context", options);
  benchmark.contexts.cases.context = true;
  if (options.has(kWindowsPart)) benchmark.windows = plan_windows(options);
  if (!options.has(kLocalMapsPart)) return benchmark;
  for (const std::size_t nodes :
       {kUsualNodesPerLocalMap / 2, kUsualNodesPerLocalMap, 2 * kUsualNodesPerLocalMap}) {
    MatchSeries series =
        make_series(std::to_string(nodes) + " nodes", with_fewer_cases(options), CandidateSet::kMatchers);
    series.nodes_per_local_map = nodes;
    benchmark.local_maps.push_back(std::move(series));
  }
  return benchmark;
}

/// All series by the number of nodes of their local maps. A log is mapped once for each number.
std::map<std::size_t, std::vector<MatchSeries*>> series_by_nodes(MatchBenchmark& benchmark,
                                                                 const MatchBenchmarkOptions& options) {
  std::map<std::size_t, std::vector<MatchSeries*>> result;
  const auto add = [&result](MatchSeries& series) { result[series.nodes_per_local_map].push_back(&series); };
  if (options.has(kScansPart)) add(benchmark.scans);
  if (options.has(kContextsPart)) add(benchmark.contexts);
  for (MatchSeries& series : benchmark.windows) add(series);
  for (MatchSeries& series : benchmark.local_maps) add(series);
  return result;
}

/// Clause about missing cases, such as "TITLE: the log has only 3 of 250 positive cases"; empty if none is
/// missing.
std::string missing_cases(std::size_t positive, std::size_t negative, const MatchSeries& series) {
  std::string missing;
  const auto add = [&](std::size_t got, const char* kind) {
    if (got >= series.cases.count) return;
    missing += (missing.empty() ? "" : " and ") + std::to_string(got) + " of " +
               std::to_string(series.cases.count) + ' ' + kind + " cases";
  };
  add(positive, "positive");
  add(negative, "negative");
  return missing.empty() ? missing : series.title + ": the log has only " + missing;
}

void add_remark(LogNote& note, const std::string& remark) {
  note.remark += (note.remark.empty() ? "" : "; ") + remark;
}

TimeFigures time_figures(std::vector<double> times_ms) {
  if (times_ms.empty()) return {};
  std::sort(times_ms.begin(), times_ms.end());
  const auto percentile = [&](std::size_t percent) { return times_ms[times_ms.size() * percent / 100]; };
  const double sum = std::accumulate(times_ms.begin(), times_ms.end(), 0.0);
  return {sum / static_cast<double>(times_ms.size()), percentile(50), percentile(95), percentile(99),
          times_ms.back()};
}

/// Number of matches of all series on one log.
double planned_matches(const std::vector<MatchSeries*>& all_series) {
  double matches = 0;
  for (const MatchSeries* series : all_series)
    matches += 2 * static_cast<double>(series->cases.count) *
               static_cast<double>(match_candidates(series->set, MapperOptions()).size());
  return matches;
}

/// Maps a log with local maps of one size, and runs all series with such maps. Calls `progress` with what is
/// being done and the number of matches made.
void run_log(const BenchmarkLog& log, std::size_t nodes, const std::vector<MatchSeries*>& all_series,
             LogNote& note, const std::function<void(const std::string& doing, double matches)>& progress) {
  const bool usual = nodes == kUsualNodesPerLocalMap;
  const std::string of_maps = usual ? "" : " with local maps of " + std::to_string(nodes) + " nodes";
  const MappedLog mapped = map_log(log, nodes, [&](double share) {
    progress("mapping " + log.name + of_maps + ' ' + fixed_text(100 * share, 0) + " %, in all", 0);
  });
  if (usual) note.translation_error_m = mapped.translation_error_m;
  if (mapped.translation_error_m > kTrustedError_m) {
    if (usual) note.used = false;
    add_remark(note, "left out" + of_maps + ": the error of its map over the relations, " +
                         fixed_text(mapped.translation_error_m, 3) + " m, is too large for a truth");
    return;
  }
  double matches = 0;
  for (MatchSeries* series : all_series) {
    const std::vector<LoopCase> cases = draw_cases(mapped, series->cases);
    const auto positive = static_cast<std::size_t>(
        std::count_if(cases.begin(), cases.end(), [](const LoopCase& one) { return one.positive; }));
    const std::size_t negative = cases.size() - positive;
    if (series == all_series.front() && usual) {
      note.positive = positive;
      note.negative = negative;
    }
    const std::string missing = missing_cases(positive, negative, *series);
    if (!missing.empty()) add_remark(note, missing);
    const std::vector<MatchCandidate> all_candidates = match_candidates(series->set, mapped.options);
    const auto& verification = mapped.options.back_end.loop_closure.verification;
    run_cases(cases, all_candidates,
              series->cases.context ? verification.min_context_response : verification.min_response, *series,
              [&] {
                matches += static_cast<double>(all_candidates.size());
                progress(log.name + ", " + series->title, matches);
              });
  }
}

}  // namespace

bool MatchBenchmarkOptions::has(const char* part) const {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

std::vector<MatchSeries> plan_windows(const MatchBenchmarkOptions& options) {
  std::vector<MatchSeries> windows;
  for (const bool context : {false, true}) {
    for (const double window_deg : {30.0, 180.0}) {
      for (const double window_m : {2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
        MatchSeries series =
            make_series("±" + fixed_text(window_m, 0) + " m, ±" + fixed_text(window_deg, 0) + "°",
                        with_fewer_cases(options), CandidateSet::kMatchers);
        series.cases.context = context;
        // Keeps window_m + clear_m constant, so that windows of all sizes have the same negative pairs.
        series.cases.clear_m += series.cases.window_m - window_m;
        series.cases.window_m = window_m;
        series.cases.window_rad = window_deg * M_PI / 180;
        windows.push_back(std::move(series));
      }
    }
  }
  return windows;
}

Judgement judge(const LoopCase& loop_case, const MatchResult& match, const MatchResult& exact,
                double accepted_response) {
  Judgement judgement;
  if (loop_case.positive) {
    const mrpt::math::TPose2D off = between(loop_case.anchor_T_node, match.map_T_robot);
    judgement.success =
        match.found && portable::hypot(off.x, off.y) <= kSuccess_m && std::abs(off.phi) <= kSuccess_rad;
    judgement.same_optimum = match.found == exact.found && (!match.found || match.response >= exact.response);
  } else {
    judgement.false_accept = match.found && match.response >= accepted_response;
  }
  return judgement;
}

void MatchTally::add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match,
                     double time_ms) {
  successes_ += judgement.success ? 1 : 0;
  same_optima_ += judgement.same_optimum ? 1 : 0;
  false_accepts_ += judgement.false_accept ? 1 : 0;
  ++searches_[static_cast<std::size_t>(match.search)];
  evaluations_ += match.evaluations;
  genetic_.decoded += match.genetic.decoded;
  genetic_.repaired += match.genetic.repaired;
  (loop_case.positive ? loop_times_ms_ : no_loop_times_ms_).push_back(time_ms);
}

MatchFigures MatchTally::figures() const {
  MatchFigures figures;
  figures.positive = loop_times_ms_.size();
  figures.negative = no_loop_times_ms_.size();
  figures.cases = figures.positive + figures.negative;
  figures.searches = searches_;
  figures.success_rate = share(successes_, figures.positive);
  figures.same_optimum_rate = share(same_optima_, figures.positive);
  figures.false_accept_rate = share(false_accepts_, figures.negative);
  if (genetic_.decoded > 0)
    figures.repaired_share = static_cast<double>(genetic_.repaired) / static_cast<double>(genetic_.decoded);
  if (figures.cases == 0) return figures;
  figures.evaluations = static_cast<double>(evaluations_) / static_cast<double>(figures.cases);
  std::vector<double> all = loop_times_ms_;
  all.insert(all.end(), no_loop_times_ms_.begin(), no_loop_times_ms_.end());
  figures.time_ms = time_figures(std::move(all));
  figures.loop_time_ms = time_figures(loop_times_ms_);
  figures.no_loop_time_ms = time_figures(no_loop_times_ms_);
  return figures;
}

std::vector<MatchCandidate> match_candidates(CandidateSet set, const MapperOptions& options) {
  GeneticOptions genetic = options.back_end.genetic;
  genetic.variant = GeneticVariant::kMemetic;
  const auto make = [&options](MatcherKind kind, const GeneticOptions& how) {
    return std::shared_ptr<const Matcher>(make_matcher(kind, options.back_end.loop_matcher, how));
  };
  GeneticOptions paper = genetic;
  paper.variant = GeneticVariant::kPaper;
  std::vector<MatchCandidate> all;
  for (const MatcherKind kind : kMatcherKinds) all.push_back({name(kind), make(kind, genetic)});
  all.push_back({"ga_paper", make(MatcherKind::kGa, paper)});
  if (set == CandidateSet::kMatchers) return all;
  for (const Ablation& ablation : kAblations) {
    GeneticOptions without = genetic;
    ablation.apply(without.memetic);
    all.push_back({ablation.name, make(MatcherKind::kGa, without)});
  }
  all.push_back({"csm_ga_paper", make(MatcherKind::kCsmGa, paper)});
  GeneticOptions few_cells = genetic;
  few_cells.coarse.cells = 256;
  all.push_back({"csm_ga with 256 cells", make(MatcherKind::kCsmGa, few_cells)});
  GeneticOptions no_generations = genetic;
  no_generations.memetic.generations = 0;
  all.push_back({"csm_ga without generations", make(MatcherKind::kCsmGa, no_generations)});
  return all;
}

void run_cases(const std::vector<LoopCase>& cases, const std::vector<MatchCandidate>& candidates,
               double accepted_response, MatchSeries& series, const std::function<void()>& after_case) {
  if (series.rows.empty())
    for (const MatchCandidate& candidate : candidates) series.rows.push_back({candidate.name, {}});
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
    // Each case starts with a different candidate, which spreads cache misses over all candidates.
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const std::size_t at = (i + k) % candidates.size();
      const Matcher& matcher = *candidates[at].matcher;
      times_ms[at] = processor_ms([&] { matches[at] = matcher.match(problem); });
    }
    for (std::size_t k = 0; k < candidates.size(); ++k)
      series.rows[k].tally.add(loop_case, judge(loop_case, matches[k], matches.front(), accepted_response),
                               matches[k], times_ms[k]);
    after_case();
  }
}

MatchBenchmark run_match_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const MatchBenchmarkOptions& options, const ProgressObserver& observer) {
  MatchBenchmark benchmark = plan(options);
  const auto by_nodes = series_by_nodes(benchmark, options);
  double all = 0;  // progress counts only matches, because mapping takes much less time
  for (const auto& [nodes, all_series] : by_nodes)
    all += static_cast<double>(logs.size()) * planned_matches(all_series);
  double done = 0;
  for (const BenchmarkLog& log : logs) {
    LogNote& note = benchmark.logs.emplace_back();
    note.name = log.name;
    note.md5 = md5_of(log.log);
    note.used = log.relations.has_value();
    if (!note.used) add_remark(note, "left out: it has no relations to check its map");
    for (const auto& [nodes, all_series] : by_nodes) {
      if (note.used)
        run_log(log, nodes, all_series, note,
                [&](const std::string& doing, double matches) { observer(doing, done + matches, all); });
      done += planned_matches(all_series);
    }
  }
  if (std::none_of(benchmark.logs.begin(), benchmark.logs.end(), [](const LogNote& log) { return log.used; }))
    throw UserError("no log can be used: " + benchmark.logs.front().name + " was " +
                    benchmark.logs.front().remark);
  return benchmark;
}

}  // namespace psi_slam
