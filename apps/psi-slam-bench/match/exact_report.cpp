// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"
#include "batch/kept_run.h"
#include "match/exact_benchmark.h"

namespace psi_slam {
namespace {

using ExactRow = ExactBenchmarkRow;

/// Column "mean / max" in Markdown.
ColumnOf<ExactRow> times(const std::string& head, SearchTimes ExactRow::*search) {
  return {{head}, [=](const ExactRow& row) {
            return cell(fixed_text((row.*search).mean_ms, 2) + " / " + fixed_text((row.*search).max_ms, 1));
          }};
}

/// Column of one time in JSON and CSV.
ColumnOf<ExactRow> time(const std::string& key, SearchTimes ExactRow::*search, double SearchTimes::*value) {
  return {{{}, key}, [=](const ExactRow& row) { return cell(row.*search.*value, 3); }};
}

ReportTable rows_table(const std::vector<ExactRow>& rows) {
  return table_of<ExactRow>(
      {column("cases", "cases", &ExactRow::cases),
       {{"threshold", "min_response"},
        [](const ExactRow& row) {
          return ReportCell{row.min_response > 0 ? fixed_text(row.min_response, 1) : "none",
                            row.min_response};
        }},
       column("number", "count", &ExactRow::count),
       column("found", "found", &ExactRow::found),
       column("equal", "equal", &ExactRow::equal),
       times("csm [ms]", &ExactRow::csm),
       times("with ambiguity [ms]", &ExactRow::csm_ambiguity),
       times("depth-first [ms]", &ExactRow::depth_first),
       time("csm_ms.mean", &ExactRow::csm, &SearchTimes::mean_ms),
       time("csm_ms.max", &ExactRow::csm, &SearchTimes::max_ms),
       time("csm_ambiguity_ms.mean", &ExactRow::csm_ambiguity, &SearchTimes::mean_ms),
       time("csm_ambiguity_ms.max", &ExactRow::csm_ambiguity, &SearchTimes::max_ms),
       time("depth_first_ms.mean", &ExactRow::depth_first, &SearchTimes::mean_ms),
       time("depth_first_ms.max", &ExactRow::depth_first, &SearchTimes::max_ms),
       {{"csm is faster"},
        [](const ExactRow& row) {
          return cell("× " + fixed_text(row.depth_first.mean_ms / row.csm.mean_ms, 1));
        }},
       column("csm: evaluations", "csm_evaluations", &ExactRow::csm_evaluations, 0),
       column("depth-first: evaluations", "depth_first_evaluations", &ExactRow::depth_first_evaluations, 0)},
      rows);
}

}  // namespace

BenchReport exact_report(const ExactBenchmark& benchmark, const ExactBenchmarkOptions& options,
                         const std::string& machine) {
  const CaseOptions cases;
  const ReportTable rows = rows_table(benchmark.rows);
  std::string text = "# Exact search\n\n" + measured_by(machine) + ", one thread. Windows of ±" +
                     fixed_text(cases.window_m, 0) + " m and ±" +
                     fixed_text(cases.window_rad * 180 / M_PI, 0) + " degrees; seed " +
                     std::to_string(options.seed) +
                     ". Times are mean / maximum of the processor time, least of " +
                     std::to_string(options.repeats) + " repetitions.\n\n";
  text +=
      "- loop, no loop: the local map shows the place of the scan, or another place\n"
      "- threshold: smallest response that a search must find\n"
      "- equal: number of cases in which both searches found the same pose, or none\n"
      "- csm: exact search, with the tables that it makes for each search and the refinement of the pose\n"
      "- depth-first: branch and bound of Hess et al. 2016 with 7 levels, in scalar code, without its grids. "
      "Making them takes " +
      fixed_text(benchmark.maximum_grids_ms, 1) +
      " ms for each local map\n"
      "- evaluations: mean number of blocks and poses scored\n\n";
  return {"exact-search.md",
          text + rows.markdown() + '\n' + logs_section(benchmark.logs, {}),
          json_file_text(report_json("psi-slam-exact-search", machine,
                                     {{"seed", options.seed},
                                      {"repeats", options.repeats},
                                      {"files", logs_table(benchmark.logs).json()},
                                      {"maximum_grids_ms", benchmark.maximum_grids_ms},
                                      {"rows", rows.json()}})),
          rows.csv(),
          {}};
}

}  // namespace psi_slam
