// SPDX-License-Identifier: BSD-3-Clause
#include "base/portable_math.h"
#include "match/match_benchmark.h"

#include <cmath>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"
#include "common/search_shares.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

/// The value rounded to `decimals`; null if it is missing or not finite.
Json rounded(const std::optional<double>& value, int decimals) {
  if (!value || !std::isfinite(*value)) return nullptr;
  const double scale = portable::pow(10.0, decimals);
  return std::round(*value * scale) / scale;
}

ReportCell percent(const std::optional<double>& share) {
  return {share ? fixed_text(100 * *share, 1) : "–", rounded(share, 6)};
}

ReportCell milliseconds(double time_ms) {
  return {fixed_text(time_ms, 3), rounded(time_ms, 6)};
}

ReportCell ratio(double part, double whole, int decimals = 2) {
  return cell(whole > 0 ? "× " + fixed_text(part / whole, decimals) : "× –");
}

/// Figures of a candidate in one series.
struct CandidateRow {
  std::string series;
  std::string matcher;
  MatchFigures figures;
  double csm_success_rate = 0;  ///< success rate of exact CSM in the series
};

std::vector<CandidateRow> rows_of(const std::vector<MatchSeries>& all_series) {
  std::vector<CandidateRow> rows;
  for (const MatchSeries& series : all_series)
    for (const MatchSeries::Row& row : series.rows)
      rows.push_back({series.title, row.matcher, row.tally.figures(),
                      series.rows.front().tally.figures().success_rate.value_or(0)});
  return rows;
}

/// The table of several series, whose names only JSON and CSV have.
ReportTable table_of_series(const std::vector<MatchSeries>& all_series) {
  using Row = CandidateRow;
  const auto share = [](const std::string& head, const std::string& key,
                        std::optional<double> MatchFigures::*value) {
    return ColumnOf<Row>{{head, key}, [=](const Row& row) { return percent(row.figures.*value); }};
  };
  const auto time_of = [](const std::string& head, const std::string& key, TimeFigures MatchFigures::*cases,
                          double TimeFigures::*value) {
    return ColumnOf<Row>{{head, key},
                         [=](const Row& row) { return milliseconds(row.figures.*cases.*value); }};
  };
  const auto time = [&](const std::string& head, const std::string& key, double TimeFigures::*value) {
    return time_of(head, "time_ms." + key, &MatchFigures::time_ms, value);
  };
  const auto loop_time = [&](const std::string& key, double TimeFigures::*value) {
    return time_of({}, "loop_time_ms." + key, &MatchFigures::loop_time_ms, value);
  };
  const auto no_loop_time = [&](const std::string& key, double TimeFigures::*value) {
    return time_of({}, "no_loop_time_ms." + key, &MatchFigures::no_loop_time_ms, value);
  };
  return table_of<Row>(
      {column({}, "series", &Row::series),
       column("matcher", "matcher", &Row::matcher),
       {{"cases", "cases"}, [](const Row& row) { return cell(row.figures.cases); }},
       share("success %", "success_rate", &MatchFigures::success_rate),
       share("same optimum %", "same_optimum_rate", &MatchFigures::same_optimum_rate),
       share("false accepts %", "false_accept_rate", &MatchFigures::false_accept_rate),
       {{"evaluations", "evaluations"},
        [](const Row& row) {
          return ReportCell{fixed_text(row.figures.evaluations, 0), rounded(row.figures.evaluations, 1)};
        }},
       time("mean ms", "mean", &TimeFigures::mean),
       time("p50 ms", "p50", &TimeFigures::p50),
       time("p95 ms", "p95", &TimeFigures::p95),
       time("p99 ms", "p99", &TimeFigures::p99),
       time("max ms", "max", &TimeFigures::max),
       loop_time("mean", &TimeFigures::mean),
       loop_time("p99", &TimeFigures::p99),
       loop_time("max", &TimeFigures::max),
       no_loop_time("mean", &TimeFigures::mean),
       no_loop_time("p99", &TimeFigures::p99),
       no_loop_time("max", &TimeFigures::max),
       {{"search that ran", "searches", true},
        [](const Row& row) { return searches_cell(row.figures.searches); }}},
      rows_of(all_series));
}

/// Table that compares each matcher with exact CSM, the first row of the series.
ReportTable against_csm(const MatchSeries& series) {
  std::vector<CandidateRow> rows = rows_of({series});
  const MatchFigures csm = rows.front().figures;
  rows.erase(rows.begin());
  using Row = CandidateRow;
  return table_of<Row>(
      {{{"against csm", {}, true}, [](const Row& row) { return cell(row.matcher); }},
       {{"successes"},
        [&](const Row& row) {
          const double successes = csm.success_rate.value_or(0);
          return successes > 0 ? ratio(*row.figures.success_rate, successes, 3) : ratio(0, 1, 3);
        }},
       {{"mean time"}, [&](const Row& row) { return ratio(row.figures.time_ms.mean, csm.time_ms.mean); }},
       {{"p99"}, [&](const Row& row) { return ratio(row.figures.time_ms.p99, csm.time_ms.p99); }}},
      rows);
}

std::string series_text(const MatchSeries& series) {
  if (series.rows.empty()) return {};
  return "## " + series.title + "\n\n" + table_of_series({series}).markdown() + '\n' +
         against_csm(series).markdown() + '\n';
}

/// The table of windows, which tells cases with a loop from cases without.
ReportTable table_of_windows(const std::vector<MatchSeries>& windows) {
  using Row = CandidateRow;
  const auto times = [](const std::string& head, TimeFigures MatchFigures::*cases) {
    return ColumnOf<Row>{{head}, [=](const Row& row) {
                           const TimeFigures& time_ms = row.figures.*cases;
                           return cell(fixed_text(time_ms.mean, 1) + " / " + fixed_text(time_ms.max, 1));
                         }};
  };
  return table_of<Row>(
      {column("window", {}, &Row::series),
       column("matcher", {}, &Row::matcher),
       {{"loops"}, [](const Row& row) { return cell(row.figures.positive); }},
       {{"success %"}, [](const Row& row) { return percent(row.figures.success_rate); }},
       {{"of csm's"},
        [](const Row& row) { return ratio(row.figures.success_rate.value_or(0), row.csm_success_rate, 3); }},
       times("loop: mean / max ms", &MatchFigures::loop_time_ms),
       {{"none"}, [](const Row& row) { return cell(row.figures.negative); }},
       times("none: mean / max ms", &MatchFigures::no_loop_time_ms)},
      rows_of(windows));
}

std::vector<MatchSeries> windows_of(const MatchBenchmark& benchmark, bool context) {
  std::vector<MatchSeries> windows;
  for (const MatchSeries& series : benchmark.windows)
    if (series.cases.context == context) windows.push_back(series);
  return windows;
}

std::string windows_text(const MatchBenchmark& benchmark) {
  std::string text;
  for (const bool context : {false, true}) {
    const std::vector<MatchSeries> windows = windows_of(benchmark, context);
    if (windows.empty()) continue;
    text += std::string("## Window sizes, ") + (context ? "scans with their context" : "single scans") +
            "\n\nEvery window has the same pairs of scan and local map. \"of csm's\" are the successes as a "
            "share of those of exact search.\n\n" +
            table_of_windows(windows).markdown() + '\n';
  }
  return text;
}

ReportTable logs_table(const std::vector<LogNote>& logs) {
  using Log = LogNote;
  return table_of<Log>({column("log", "name", &Log::name),
                        {{"MD5", "md5", true},
                         [](const Log& log) {
                           return ReportCell{'`' + log.md5 + '`', log.md5};
                         }},
                        {{{}, "used"},
                         [](const Log& log) {
                           return ReportCell{{}, log.used};
                         }},
                        {{"error of its map [m]", "translation_error_m"},
                         [](const Log& log) {
                           const auto& error_m = log.translation_error_m;
                           return ReportCell{error_m ? fixed_text(*error_m, 3) : "–", rounded(error_m, 6)};
                         }},
                        column("positive", "positive", &Log::positive),
                        column("negative", "negative", &Log::negative),
                        column("remark", "remark", &Log::remark)},
                       logs);
}

Json windows_json(const std::vector<MatchSeries>& windows) {
  Json list = Json::array();
  for (const MatchSeries& series : windows)
    list.push_back({{"window_m", series.cases.window_m},
                    {"window_deg", rounded(series.cases.window_rad * 180 / M_PI, 6)},
                    {"context", series.cases.context},
                    {"matchers", table_of_series({series}).json()}});
  return list;
}

/// Adds a label for each of the series, and the mean times of each matcher at these labels as a line.
void add_times(const std::vector<MatchSeries>& windows, GrowthPlot& plot) {
  for (const MatchSeries& series : windows) {
    plot.labels.push_back(series.title);
    for (std::size_t i = 0; i < series.rows.size(); ++i) {
      if (plot.lines.size() <= i) plot.lines.push_back({series.rows[i].matcher, {}});
      plot.lines[i].values.push_back(spread_of({series.rows[i].tally.figures().time_ms.mean}));
    }
  }
}

/// Plot of the windows of +-180 degrees, with those of +-30 degrees as faint lines.
std::string windows_plot(const std::vector<MatchSeries>& windows, const std::string& title) {
  const auto middle = windows.begin() + static_cast<std::ptrdiff_t>(windows.size() / 2);
  GrowthPlot narrow;
  add_times({windows.begin(), middle}, narrow);
  GrowthPlot all;
  add_times({middle, windows.end()}, all);
  GrowthPlot plot;
  plot.title = title;
  plot.labels = all.labels;
  for (std::size_t i = 0; i < all.lines.size(); ++i) {
    plot.lines.push_back(all.lines[i]);
    if (i >= narrow.lines.size()) continue;
    plot.lines.push_back(narrow.lines[i]);
    plot.lines.back().faint = true;
  }
  return growth_svg(plot);
}

std::string markdown_of(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                        const std::string& machine) {
  const CaseOptions& cases = benchmark.scans.cases;
  std::string text =
      "# Matchers compared\n\n" + measured_by(machine) +
      ", one thread. Every matcher searched every case, unless a table states another window: ±" +
      fixed_text(cases.window_m, 0) + " m and ±" + fixed_text(cases.window_rad * 180 / M_PI, 0) +
      " degrees around a start pose that is up to " + fixed_text(cases.start_share * cases.window_m, 1) +
      " m and " + fixed_text(cases.turn_share * cases.window_rad * 180 / M_PI, 0) +
      " degrees off the truth; seed " + std::to_string(options.seed) + ".\n\n";
  text +=
      "- success: share of the positive cases with a match within 0.3 m and 3.5 degrees of the truth\n"
      "- same optimum: share of the positive cases with a match at least as good as that of exact CSM, or "
      "with no match by either\n"
      "- false accepts: share of the negative cases (the scan was taken elsewhere) with a response that loop "
      "closing would accept before it verifies the match\n"
      "- search that ran: matchers choose it by the size of the window; see matchers.md for the names\n"
      "- evaluations: mean number of poses scored, on all levels of the score grid; times are processor "
      "times over all cases\n\n" +
      logs_table(benchmark.logs).markdown() + '\n';
  text += series_text(benchmark.scans) + series_text(benchmark.contexts) + windows_text(benchmark);
  text.pop_back();
  return text;
}

Json json_of(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
             const std::string& machine) {
  const CaseOptions& cases = benchmark.scans.cases;
  Json json = {{"matchers", table_of_series({benchmark.scans}).json()}};
  json.update(report_json("psi-slam-match-benchmark", machine,
                          {{"seed", options.seed},
                           {"window_m", cases.window_m},
                           {"window_deg", rounded(cases.window_rad * 180 / M_PI, 6)},
                           {"logs", logs_table(benchmark.logs).json()},
                           {"context", {{"matchers", table_of_series({benchmark.contexts}).json()}}}}));
  if (!benchmark.windows.empty()) json["windows"] = windows_json(benchmark.windows);
  return json;
}

}  // namespace

BenchReport match_report(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                         const std::string& machine) {
  std::vector<MatchSeries> all_series{benchmark.scans, benchmark.contexts};
  all_series.insert(all_series.end(), benchmark.windows.begin(), benchmark.windows.end());
  BenchReport report{"match.md",
                     markdown_of(benchmark, options, machine),
                     json_file_text(json_of(benchmark, options, machine)),
                     table_of_series(all_series).csv(),
                     {}};
  for (const bool context : {false, true})
    if (const auto windows = windows_of(benchmark, context); !windows.empty())
      report.plots.push_back(
          {context ? "match-windows-context.svg" : "match-windows.svg",
           windows_plot(windows, std::string("Mean time of a match by its window (faint: ±30°), ") +
                                     (context ? "scans with context" : "single scans"))});
  return report;
}

}  // namespace psi_slam
