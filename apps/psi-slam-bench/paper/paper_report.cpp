// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/search_shares.h"
#include "freiburg/freiburg_comparison.h"
#include "paper/paper_benchmark.h"

namespace psi_slam {
namespace {

using Column = ColumnOf<PaperRow>;

/// Column with a time of the back end, in milliseconds.
Column time_column(const std::string& head, const std::string& key, double BackEndTimes::*time_ms) {
  return {{head, key}, [=](const PaperRow& row) { return cell(row.times.*time_ms, 1); }};
}

/// Column that is missing in Markdown.
template <class ValueOf>
Column data_column(const std::string& key, const ValueOf& value_of) {
  return {{{}, key}, [=](const PaperRow& row) { return ReportCell{{}, value_of(row)}; }};
}

ReportTable runs_table(const std::vector<PaperRow>& rows) {
  using Row = PaperRow;
  std::vector<Column> columns{
      column("log", "log", &Row::log),
      column("matcher", "matcher", &Row::matcher),
      column("loops closed", "loops", &Row::loops),
      {{"false of judged"},
       [](const Row& row) {
         return cell(std::to_string(row.loops_false) + " of " + std::to_string(row.loops_judged));
       }},
      data_column("loops_false", [](const Row& row) { return row.loops_false; }),
      data_column("loops_judged", [](const Row& row) { return row.loops_judged; }),
      column("windows searched", "windows", &Row::windows),
      {{"deadline [ms]", "deadline_ms"}, [](const Row& row) { return cell(row.period_ms, 0); }},
      {{"deadline misses"},
       [](const Row& row) {
         return cell(std::to_string(row.times.deadline_misses) + " of " + std::to_string(row.times.searches));
       }},
      data_column("deadline_misses", [](const Row& row) { return row.times.deadline_misses; }),
      data_column("searches", [](const Row& row) { return row.times.searches; }),
      time_column("back end p50 [ms]", "back_end_ms.p50", &BackEndTimes::p50_ms),
      time_column("p99 [ms]", "back_end_ms.p99", &BackEndTimes::p99_ms),
      time_column("max [ms]", "back_end_ms.max", &BackEndTimes::max_ms),
      {{"search that ran", "search_kinds", true},
       [](const Row& row) { return searches_cell(row.searches); }}};
  for (std::size_t i = 0; i < kPaperFigures; ++i)
    columns.push_back(data_column(kPathFigures[i].key, [i](const Row& row) {
      const MeanAndStd& errors = row.figures.errors.*kPathFigures[i].errors;
      return nlohmann::ordered_json{{"mean", errors.mean}, {"std", errors.std}};
    }));
  columns.push_back(data_column("scans", [](const Row& row) { return row.figures.scans; }));
  columns.push_back(data_column("relations", [](const Row& row) { return row.figures.relations_used; }));
  columns.push_back(data_column("wall_s", [](const Row& row) { return row.figures.wall_s; }));
  columns.push_back(data_column("cpu_s", [](const Row& row) { return row.figures.cpu_s; }));
  return table_of(columns, rows);
}

/// Errors of one system on one log, ours or published.
struct ErrorRow {
  std::string log;
  std::string system;
  PublishedErrors errors;
};

/// The systems of the paper's tables 1 and 2, in the order of published_systems().
bool is_of_paper(const PublishedSystem& system) {
  constexpr const char* kSuffix = " (paper)";
  return system.name.size() > std::string(kSuffix).size() &&
         system.name.rfind(kSuffix) == system.name.size() - std::string(kSuffix).size();
}

std::vector<ErrorRow> error_rows(const std::vector<PaperRow>& rows) {
  std::vector<ErrorRow> errors;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ErrorRow& ours = errors.emplace_back(ErrorRow{rows[i].log, rows[i].matcher, {}});
    for (std::size_t k = 0; k < kPaperFigures; ++k) {
      const MeanAndStd& figure = rows[i].figures.errors.*kPathFigures[k].errors;
      ours.errors[k] = PublishedFigure{figure.mean, figure.std};
    }
    if (i + 1 < rows.size() && rows[i + 1].log == rows[i].log) continue;
    for (const PublishedSystem& system : published_systems())
      if (const PublishedErrors* published = system.errors_of(benchmark_log_name(rows[i].log));
          published != nullptr && is_of_paper(system))
        errors.push_back({rows[i].log, system.name, *published});
  }
  return errors;
}

ReportTable errors_table(const std::vector<PaperRow>& rows) {
  std::vector<ColumnOf<ErrorRow>> columns{column("log", "log", &ErrorRow::log),
                                          column("matcher or system", "system", &ErrorRow::system)};
  for (std::size_t i = 0; i < kPaperFigures; ++i)
    columns.push_back({{kPathFigures[i].name}, [i](const ErrorRow& row) {
                         const PublishedFigure& figure = row.errors[i].value();
                         return cell(errors_text({figure.mean, figure.std.value_or(0)}));
                       }});
  return table_of(columns, error_rows(rows));
}

std::string markdown_of(const PaperBenchmark& benchmark, const PaperOptions& options,
                        const std::string& machine) {
  std::string text =
      "# The experiment of the paper\n\nThis page repeats section 4 of the paper: exact search, genetic "
      "search "
      "and the switch by Ψ close the loops of the same logs.\n\n" +
      measured_by(machine) + ", one thread, seed " + std::to_string(options.seed) +
      ".\n\n"
      "- Every window is ±8 m and ±30 degrees around the predicted pose. A single scan is matched with each "
      "local map nearby.\n"
      "- Scans are processed one at a time. A search has one scan period as its deadline: the median time "
      "between two scans of the log. A search that misses the deadline is counted, not cut short.\n"
      "- There is no final loop search and no joint refinement: a map has only the loops found while the log "
      "is read.\n"
      "- The front end, the verification of loops and the optimisation are those of psi-slam for all "
      "matchers.\n"
      "- back end: time of loop closing and optimisation of each scan that searches for loops\n"
      "- loops closed: accepted loops in the finished graph; false of judged: those that a relation "
      "contradicts, out of those that a relation can judge\n";
  for (const PaperCandidate& candidate : options.candidates())
    text += "- " + candidate.name + ": " + candidate.meaning + '\n';
  text +=
      "\nThe paper gives no population, generations, rates and thresholds of Ψ; these values are ours (see "
      "matchers.md).\n\n## Loops and deadlines\n\n" +
      runs_table(benchmark.rows).markdown() +
      "\n## Errors beside the paper's tables 1 and 2\n\nMean ± standard deviation over the relations. "
      "Figures of systems marked \"(paper)\" are those of the paper, measured there with another front end "
      "and on another machine.\n\n" +
      errors_table(benchmark.rows).markdown() + '\n';
  return text + logs_section(benchmark.identities, benchmark.without_relations);
}

}  // namespace

BenchReport paper_report(const PaperBenchmark& benchmark, const PaperOptions& options,
                         const std::string& machine) {
  std::vector<std::string> matchers;
  for (const PaperCandidate& candidate : options.candidates()) matchers.push_back(candidate.name);
  const ReportTable runs = runs_table(benchmark.rows);
  return {"paper.md",
          markdown_of(benchmark, options, machine),
          json_file_text(report_json("psi-slam-paper-benchmark", machine,
                                     {{"seed", options.seed},
                                      {"matchers", matchers},
                                      {"logs", logs_table(benchmark.identities).json()},
                                      {"rows", runs.json()}})),
          runs.csv(),
          {}};
}

}  // namespace psi_slam
