// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <mrpt/system/md5.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
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

constexpr std::size_t kFewerCases = 5;  // series over window sizes draw a fifth of the cases

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
  if (options.has(kWindowsPart)) benchmark.windows = plan_windows(options);
  return benchmark;
}

std::vector<MatchSeries*> chosen_series(MatchBenchmark& benchmark, const MatchBenchmarkOptions& options) {
  std::vector<MatchSeries*> chosen;
  if (options.has(kScansPart)) chosen.push_back(&benchmark.scans);
  if (options.has(kContextsPart)) chosen.push_back(&benchmark.contexts);
  for (MatchSeries& series : benchmark.windows) chosen.push_back(&series);
  return chosen;
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
  const auto candidates = static_cast<double>(match_candidates(MapperOptions()).size());
  double matches = 0;
  for (const MatchSeries* series : all_series)
    matches += 2 * static_cast<double>(series->cases.count) * candidates;
  return matches;
}

/// Maps a log and runs all series on it. Calls `progress` with what is being done and the number of matches
/// made.
void run_log(const BenchmarkLog& log, const std::vector<MatchSeries*>& all_series, LogNote& note,
             const std::function<void(const std::string& doing, double matches)>& progress) {
  const MappedLog mapped = map_log(log, [&](double share) {
    progress("mapping " + log.name + ' ' + fixed_text(100 * share, 0) + " %, in all", 0);
  });
  note.translation_error_m = mapped.translation_error_m;
  if (mapped.translation_error_m > kTrustedError_m) {
    note.used = false;
    add_remark(note, "left out: the error of its map over the relations, " +
                         fixed_text(mapped.translation_error_m, 3) + " m, is too large for a truth");
    return;
  }
  const std::vector<MatchCandidate> candidates = match_candidates(mapped.options);
  double matches = 0;
  for (MatchSeries* series : all_series) {
    const std::vector<LoopCase> cases = draw_cases(mapped, series->cases);
    const auto positive = static_cast<std::size_t>(
        std::count_if(cases.begin(), cases.end(), [](const LoopCase& one) { return one.positive; }));
    const std::size_t negative = cases.size() - positive;
    if (series == all_series.front()) {
      note.positive = positive;
      note.negative = negative;
    }
    const std::string missing = missing_cases(positive, negative, *series);
    if (!missing.empty()) add_remark(note, missing);
    const auto& verification = mapped.options.back_end.loop_closure.verification;
    run_cases(cases, candidates,
              series->cases.context ? verification.min_context_response : verification.min_response, *series,
              [&] {
                matches += static_cast<double>(candidates.size());
                progress(log.name + ", " + series->title, matches);
              });
  }
}

}  // namespace

bool MatchBenchmarkOptions::has(const char* part) const {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

std::vector<MatchSeries> plan_windows(const MatchBenchmarkOptions& options) {
  MatchBenchmarkOptions fewer = options;
  fewer.cases = std::max<std::size_t>(1, options.cases / kFewerCases);
  std::vector<MatchSeries> windows;
  for (const bool context : {false, true}) {
    for (const double window_deg : {30.0, 180.0}) {
      for (const double window_m : {2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
        MatchSeries series =
            make_series("±" + fixed_text(window_m, 0) + " m, ±" + fixed_text(window_deg, 0) + "°", fewer);
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
  if (figures.cases == 0) return figures;
  figures.evaluations = static_cast<double>(evaluations_) / static_cast<double>(figures.cases);
  std::vector<double> all = loop_times_ms_;
  all.insert(all.end(), no_loop_times_ms_.begin(), no_loop_times_ms_.end());
  figures.time_ms = time_figures(std::move(all));
  figures.loop_time_ms = time_figures(loop_times_ms_);
  figures.no_loop_time_ms = time_figures(no_loop_times_ms_);
  return figures;
}

std::vector<MatchCandidate> match_candidates(const MapperOptions& options) {
  std::vector<MatchCandidate> all;
  const auto add = [&](const std::string& candidate, MatcherKind kind, GeneticVariant variant) {
    GeneticOptions genetic = options.back_end.genetic;
    genetic.variant = variant;
    all.push_back({candidate, make_matcher(kind, options.back_end.loop_matcher, genetic)});
  };
  for (const MatcherKind kind : kMatcherKinds) add(name(kind), kind, GeneticVariant::kMemetic);
  for (const MatcherKind kind : {MatcherKind::kCsmGa, MatcherKind::kGa})
    add(name(kind) + std::string("_paper"), kind, GeneticVariant::kPaper);
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
  const std::vector<MatchSeries*> all_series = chosen_series(benchmark, options);
  const double of_a_log = planned_matches(all_series);  // progress counts only matches; mapping is quicker
  double done = 0;
  for (const BenchmarkLog& log : logs) {
    LogNote& note = benchmark.logs.emplace_back();
    note.name = log.name;
    note.md5 = md5_of(log.log);
    note.used = log.relations.has_value();
    if (note.used)
      run_log(log, all_series, note, [&](const std::string& doing, double matches) {
        observer(doing, done + matches, static_cast<double>(logs.size()) * of_a_log);
      });
    else
      add_remark(note, "left out: it has no relations to check its map");
    done += of_a_log;
  }
  if (std::none_of(benchmark.logs.begin(), benchmark.logs.end(), [](const LogNote& log) { return log.used; }))
    throw UserError("no log can be used: " + benchmark.logs.front().name + " was " +
                    benchmark.logs.front().remark);
  return benchmark;
}

}  // namespace psi_slam
