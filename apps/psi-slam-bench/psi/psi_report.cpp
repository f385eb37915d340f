// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/search_shares.h"
#include "psi/psi_benchmark.h"
#include "sparse/node_costs.h"

namespace psi_slam {
namespace {

/// Searches of one matcher in one stratum, over all logs.
struct StratumRow {
  std::size_t stratum = 0;
  std::string matcher;
  PsiStratum sum;
};

std::vector<StratumRow> rows_of(const PsiBenchmark& benchmark, const PsiBenchmarkOptions& options) {
  std::vector<StratumRow> rows;
  for (std::size_t stratum = 0; stratum <= kPsiStrata.size(); ++stratum)
    for (const std::string& matcher : options.matchers) {
      StratumRow& row = rows.emplace_back(StratumRow{stratum, matcher, {}});
      for (const PsiRun& run : benchmark.runs)
        if (run.matcher == matcher) row.sum += run.strata.at(stratum);
    }
  return rows;
}

/// A sum divided by a count; nothing if the count is 0.
std::optional<double> ratio(double sum, std::size_t count) {
  return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

ReportTable strata_table(const PsiBenchmark& benchmark, const PsiBenchmarkOptions& options) {
  using Row = StratumRow;
  const auto count = [](const std::string& head, const std::string& key, std::size_t PsiStratum::*value) {
    return ColumnOf<Row>{{head, key}, [=](const Row& row) { return cell(row.sum.*value); }};
  };
  const auto time = [](const std::string& head, const std::string& key, double share) {
    return ColumnOf<Row>{{head, key},
                         [=](const Row& row) { return cell(quantile(row.sum.scan_ms, share), 2); }};
  };
  return table_of<Row>(
      {{{"Ψ", "psi", true}, [](const Row& row) { return cell(psi_stratum_name(row.stratum)); }},
       column("matcher", "matcher", &Row::matcher),
       count("scans", "scans", &PsiStratum::scans),
       count("windows", "windows", &PsiStratum::windows),
       {{"found %", "found_share"},
        [](const Row& row) {
          return cell(ratio(static_cast<double>(row.sum.found), row.sum.windows), 1, 100);
        }},
       {{"mean response", "mean_response"},
        [](const Row& row) { return cell(ratio(row.sum.response_sum, row.sum.found), 4); }},
       count("loops", "loops", &PsiStratum::loops),
       {{"ms per window", "window_ms"},
        [](const Row& row) {
          const std::vector<double>& scan_ms = row.sum.scan_ms;
          return cell(ratio(std::accumulate(scan_ms.begin(), scan_ms.end(), 0.0), row.sum.windows), 3);
        }},
       time("ms per scan: p50", "scan_ms.p50", 0.5),
       time("p99", "scan_ms.p99", 0.99),
       time("max", "scan_ms.max", 1),
       {{"search that ran", "search_kinds", true},
        [](const Row& row) { return searches_cell(row.sum.searches); }}},
      rows_of(benchmark, options));
}

ReportTable runs_table(const PsiBenchmark& benchmark) {
  using Row = PsiRun;
  const auto errors = [](std::size_t figure) {
    const PathFigure& path = kPathFigures[figure];
    return ColumnOf<Row>{{path.name, path.key}, [=](const Row& row) {
                           const MeanAndStd& one = row.figures.errors.*path.errors;
                           return ReportCell{errors_text(one), {{"mean", one.mean}, {"std", one.std}}};
                         }};
  };
  return table_of<Row>({column("log", "log", &Row::log),
                        column("matcher", "matcher", &Row::matcher),
                        errors(0),
                        errors(2),
                        column("loops", "loops", &Row::loops),
                        column("loop matching [s]", "loop_matching_s", &Row::loop_matching_s, 2),
                        column("largest scan [ms]", "max_scan_ms", &Row::max_scan_ms, 1),
                        {{"CPU [s]", "cpu_s"}, [](const Row& row) { return cell(row.figures.cpu_s, 1); }}},
                       benchmark.runs);
}

std::string markdown_of(const PsiBenchmark& benchmark, const PsiBenchmarkOptions& options,
                        const std::string& machine) {
  return "# Matchers over the factor Ψ\n\nWhole runs with one matcher for all windows, and with the matcher "
         "that Ψ chooses (adaptive). The scans that searched for loops are divided into strata by their "
         "Ψ.\n\n" +
         measured_by(machine) + ", one thread, seed " + std::to_string(options.seed) +
         ".\n\n"
         "- windows: windows searched while the log was read, without the final search\n"
         "- found: share of the windows with a match, before it is verified\n"
         "- loops: loops that became constraints at these scans\n"
         "- ms: time of matching without verification\n\n"
         "## By Ψ, over all logs\n\nThe runs of different matchers differ slightly in Ψ, so the numbers of "
         "scans differ.\n\n" +
         strata_table(benchmark, options).markdown() +
         "\n## Whole runs\n\nLoop matching includes the final search. The largest scan is that with the "
         "longest matching time, without the final search.\n\n" +
         runs_table(benchmark).markdown() + '\n' +
         logs_section(benchmark.identities, benchmark.without_relations);
}

}  // namespace

BenchReport psi_report(const PsiBenchmark& benchmark, const PsiBenchmarkOptions& options,
                       const std::string& machine) {
  const ReportTable strata = strata_table(benchmark, options);
  return {"psi.md",
          markdown_of(benchmark, options, machine),
          json_file_text(report_json("psi-slam-psi-benchmark", machine,
                                     {{"seed", options.seed},
                                      {"logs", logs_table(benchmark.identities).json()},
                                      {"strata", strata.json()},
                                      {"runs", runs_table(benchmark).json()}})),
          strata.csv(),
          {}};
}

}  // namespace psi_slam
