// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/growth_plot.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const std::optional<double>& share, int decimals = 1) {
  return share ? fixed_text(100 * *share, decimals) : "–";
}

std::string row_text(const std::string& first, const std::string& matcher, const MatchFigures& figures) {
  return "| " + first + matcher + " | " + std::to_string(figures.cases) + " | " +
         percent(figures.success_rate) + " | " + percent(figures.same_optimum_rate) + " | " +
         percent(figures.false_accept_rate) + " | " + fixed_text(figures.evaluations, 0) + " | " +
         fixed_text(figures.time_ms.mean, 3) + " | " + fixed_text(figures.time_ms.p50, 3) + " | " +
         fixed_text(figures.time_ms.p95, 3) + " | " + fixed_text(figures.time_ms.p99, 3) + " | " +
         percent(figures.repaired_share) + " |\n";
}

std::string header_text(const std::string& first) {
  std::string rule = "|---|";
  if (!first.empty()) rule += "---|";
  for (int column = 0; column < 9; ++column) rule += "---:|";
  return "| " + first +
         "matcher | cases | success % | same optimum % | false accepts % | evaluations | mean ms | p50 ms | "
         "p95 ms | p99 ms | repaired % |\n" +
         rule + "---:|\n";
}

std::string ratio_text(double part, double whole) {
  return whole > 0 ? fixed_text(part / whole, 2) : "–";
}

/// What the goals are told by: each matcher against exact CSM.
std::string against_csm(const MatchSeries& series) {
  if (series.rows.empty()) return {};
  const MatchFigures csm = series.rows.front().tally.figures();
  std::string text = "| against csm | successes | mean time | p99 |\n|---|---:|---:|---:|\n";
  for (std::size_t i = 1; i < series.rows.size(); ++i) {
    const MatchFigures figures = series.rows[i].tally.figures();
    text += "| " + series.rows[i].matcher + " | × " +
            fixed_text(csm.success_rate.value_or(0) > 0 ? *figures.success_rate / *csm.success_rate : 0, 3) +
            " | × " + ratio_text(figures.time_ms.mean, csm.time_ms.mean) + " | × " +
            ratio_text(figures.time_ms.p99, csm.time_ms.p99) + " |\n";
  }
  return text;
}

std::string series_text(const MatchSeries& series) {
  std::string text = "## " + series.title + "\n\n" + header_text("");
  for (const MatchSeries::Row& row : series.rows) text += row_text("", row.matcher, row.tally.figures());
  return text + '\n' + against_csm(series) + '\n';
}

std::string sizes_text(const std::string& title, const std::string& column, const std::string& note,
                       const std::vector<MatchSeries>& sizes) {
  if (sizes.empty()) return {};
  std::string text = "## " + title + "\n\n" + note + "\n\n" + header_text(column + " | ");
  for (const MatchSeries& series : sizes)
    for (const MatchSeries::Row& row : series.rows)
      text += row_text(series.title + " | ", row.matcher, row.tally.figures());
  return text + '\n';
}

std::string logs_text(const std::vector<LogNote>& logs) {
  std::string text =
      "| log | MD5 | error of its map [m] | positive | negative | |\n|---|---|---:|---:|---:|---|\n";
  for (const LogNote& log : logs)
    text += "| " + log.name + " | `" + log.md5 + "` | " +
            (log.translation_error_m ? fixed_text(*log.translation_error_m, 3) : "–") + " | " +
            std::to_string(log.positive) + " | " + std::to_string(log.negative) + " | " + log.remark + " |\n";
  return text;
}

/// Rounded to what is worth reading; null where there is none.
Json number(const std::optional<double>& value, int decimals) {
  if (!value || !std::isfinite(*value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  return std::round(*value * scale) / scale;
}

Json rows_json(const MatchSeries& series) {
  Json rows = Json::array();
  for (const MatchSeries::Row& row : series.rows) {
    const MatchFigures figures = row.tally.figures();
    rows.push_back({{"matcher", row.matcher},
                    {"cases", figures.cases},
                    {"success_rate", number(figures.success_rate, 6)},
                    {"same_optimum_rate", number(figures.same_optimum_rate, 6)},
                    {"false_accept_rate", number(figures.false_accept_rate, 6)},
                    {"evaluations", number(figures.evaluations, 1)},
                    {"time_ms",
                     {{"mean", number(figures.time_ms.mean, 6)},
                      {"p50", number(figures.time_ms.p50, 6)},
                      {"p95", number(figures.time_ms.p95, 6)},
                      {"p99", number(figures.time_ms.p99, 6)}}}});
  }
  return rows;
}

Json repaired_json(const MatchSeries& series) {
  Json shares = Json::object();
  for (const MatchSeries::Row& row : series.rows)
    if (const auto share = row.tally.figures().repaired_share) shares[row.matcher] = number(share, 6);
  return shares;
}

Json logs_json(const std::vector<LogNote>& logs) {
  Json list = Json::array();
  for (const LogNote& log : logs)
    list.push_back({{"name", log.name},
                    {"md5", log.md5},
                    {"used", log.used},
                    {"translation_error_m", number(log.translation_error_m, 6)},
                    {"positive", log.positive},
                    {"negative", log.negative},
                    {"remark", log.remark}});
  return list;
}

Json sizes_json(const std::vector<MatchSeries>& sizes) {
  Json list = Json::array();
  for (const MatchSeries& series : sizes)
    list.push_back({{"window_m", series.cases.window_m},
                    {"nodes_per_local_map", series.nodes_per_local_map},
                    {"matchers", rows_json(series)}});
  return list;
}

GrowthPlot plot_of(const std::vector<MatchSeries>& sizes) {
  GrowthPlot plot;
  for (const MatchSeries& series : sizes) {
    plot.labels.push_back(series.title);
    for (std::size_t i = 0; i < series.rows.size(); ++i) {
      if (plot.lines.size() <= i) plot.lines.push_back({series.rows[i].matcher, {}});
      plot.lines[i].values.push_back(series.rows[i].tally.figures().time_ms.mean);
    }
  }
  return plot;
}

}  // namespace

std::string match_markdown(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                           const std::string& machine) {
  const CaseOptions& cases = benchmark.scans.cases;
  std::string text = "# Matchers compared\n\n";
  text += "psi-slam " PSI_SLAM_VERSION ", " + machine + ", one thread. Every matcher searched every case, ±" +
          fixed_text(cases.window_m, 0) + " m and ±" + fixed_text(cases.window_rad * 180 / M_PI, 0) +
          " degrees around a start up to " + fixed_text(cases.start_share * cases.window_m, 1) + " m and " +
          fixed_text(cases.turn_share * cases.window_rad * 180 / M_PI, 0) + " degrees off the truth; seed " +
          std::to_string(options.seed) + ".\n\n";
  text +=
      "- success: of the positive cases, found within 0.3 m and 3.5 degrees of the truth\n"
      "- same optimum: of the positive cases, as good a pose as exact CSM's, or none found like there\n"
      "- false accepts: of the negative cases (the scan was taken elsewhere), those with a response that "
      "loop "
      "closing would accept before it verifies\n"
      "- evaluations: poses scored on any level of the score grid, mean; times over all cases\n"
      "- repaired: codes that lay outside the window, of those that became poses\n"
      "- adaptive: ";
  text += std::string(kAdaptiveNote) + "\n\n";
  text += logs_text(benchmark.logs) + '\n';
  text += series_text(benchmark.scans) + series_text(benchmark.contexts);
  text += sizes_text("Window sizes", "half-width",
                     "The same pairs of scan and local map in every window; fewer cases than above.",
                     benchmark.windows);
  text += sizes_text("Sizes of local maps", "local maps of",
                     "Every log mapped anew with each size; fewer cases than above.", benchmark.local_maps);
  text.pop_back();
  return text;
}

std::string match_json(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                       const std::string& machine) {
  const CaseOptions& cases = benchmark.scans.cases;
  Json json = {{"matchers", rows_json(benchmark.scans)},
               {"schema", "psi-slam-match-benchmark"},
               {"schema_version", 1},
               {"program_version", PSI_SLAM_VERSION},
               {"machine", machine},
               {"seed", options.seed},
               {"window_m", cases.window_m},
               {"window_deg", number(cases.window_rad * 180 / M_PI, 6)},
               {"logs", logs_json(benchmark.logs)},
               {"repaired_share", repaired_json(benchmark.scans)},
               {"context", {{"matchers", rows_json(benchmark.contexts)}}}};
  if (!benchmark.windows.empty()) {
    json["windows"] = sizes_json(benchmark.windows);
    json["local_maps"] = sizes_json(benchmark.local_maps);
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string window_plot(const MatchBenchmark& benchmark) {
  GrowthPlot plot = plot_of(benchmark.windows);
  plot.title = "Mean time of a match by the half-width of its window";
  return growth_svg(plot);
}

std::string local_map_plot(const MatchBenchmark& benchmark) {
  GrowthPlot plot = plot_of(benchmark.local_maps);
  plot.title = "Mean time of a match by the size of the local map";
  return growth_svg(plot);
}

}  // namespace psi_slam
