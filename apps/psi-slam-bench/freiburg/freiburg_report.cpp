// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "freiburg/freiburg_comparison.h"
#include "freiburg/freiburg_figures.h"
#include "freiburg/freiburg_baselines.h"
#include "common/program_identity.h"
#include "batch/markdown_cells.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

std::string range_text(const SeedSpread& spread) {
  if (spread.count < 2) return "–";
  return fixed_text(spread.std, 5) + " (" + fixed_text(spread.min, 4) + " – " + fixed_text(spread.max, 4) +
         ')';
}

/// "10", "8, 2 failed", "1 run: draws no random numbers".
std::string runs_text(const FreiburgCell& cell, const CellFigures& figures) {
  std::string text = std::to_string(figures.runs);
  if (figures.failed > 0) text += ", " + std::to_string(figures.failed) + " failed";
  if (!draws_random_numbers(cell.matcher)) text += " run: draws no random numbers";
  return text;
}

/// The reason if it is the same for all runs.
std::string failed_row(const FreiburgCell& cell) {
  return "| " + cell.log + " | " + cell.matcher + " | failed: " + cell_text(cell.runs.front().failure);
}

/// "0.2 of 512.0 | 93.1": two cells.
std::string judged_text(const CellFigures& figures) {
  return fixed_text(figures.loops_false.mean, 1) + " of " + fixed_text(figures.loops_judged.mean, 1) + " | " +
         (figures.loop_recall ? fixed_text(100 * figures.loop_recall->mean, 1) : "–");
}

std::string matchers_table(const FreiburgBenchmark& benchmark) {
  std::string text = "| log | matcher | runs |" + path_figure_heads();
  constexpr std::size_t kOthers = 8;
  text +=
      " relations used | loops accepted | false of judged | recall % | wall [s] | CPU [s] | × real time | "
      "peak [MiB] |\n|---|---|---|" +
      repeated("---:|", kPathFigures.size() + kOthers) + '\n';
  for (const FreiburgCell& cell : benchmark.cells) {
    const auto figures = figures_of(cell);
    if (!figures) {
      text += failed_row(cell) + repeated(" | –", kPathFigures.size() + kOthers) + " |\n";
      continue;
    }
    text += "| " + cell.log + " | " + cell.matcher + " | " + runs_text(cell, *figures);
    for (const PathFigure& figure : kPathFigures) text += " | " + errors_text(figures->errors.*figure.errors);
    text += " | " + fixed_text(figures->relations_used, 0) + " | " +
            fixed_text(figures->loops_accepted.mean, 1) + " | " + judged_text(*figures) + " | " +
            fixed_text(figures->wall_s.mean, 2) + " | " + fixed_text(figures->cpu_s.mean, 2) + " | " +
            fixed_text(figures->real_time_factor.mean, 0) + " | " +
            fixed_text(figures->peak_memory_mib.mean, 0) + " |\n";
  }
  return text;
}

std::string spread_table(const FreiburgBenchmark& benchmark) {
  std::string text = "| log | matcher | runs |";
  for (std::size_t i = 0; i < kPaperFigures; ++i) text += ' ' + std::string(kPathFigures[i].name) + " |";
  text += "\n|---|---|---:|" + repeated("---:|", kPaperFigures) + '\n';
  for (const FreiburgCell& cell : benchmark.cells) {
    const auto figures = figures_of(cell);
    if (!figures) continue;
    const bool random = draws_random_numbers(cell.matcher);
    text += "| " + cell.log + " | " + cell.matcher + " | " + runs_text(cell, *figures);
    for (std::size_t i = 0; i < kPaperFigures; ++i)
      text += " | " + (random ? range_text(figures->spread[i]) : "0 by construction");
    text += " |\n";
  }
  return text;
}

std::string failures_text(const FreiburgBenchmark& benchmark) {
  std::string text;
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& run : cell.runs)
      if (!run.figures)
        text += "- " + cell.log + ", " + cell.matcher + ", seed " + std::to_string(run.seed) +
                ": failed: " + run.failure + '\n';
  return text.empty() ? text : "## Runs that failed\n\n" + text + '\n';
}

std::string sources_text(const Comparison& comparison) {
  std::string text;
  for (const ComparisonColumn& column : comparison.columns)
    text += "- " + column.name + ": " + column.source + '\n';
  return text;
}

/// Logs of the benchmark that no row of ours stands for, and why.
std::string missing_text(const FreiburgBenchmark& benchmark) {
  std::string text;
  for (const BenchmarkLogTitle& title : benchmark_log_titles()) {
    const auto is_it = [&](const std::string& name) { return benchmark_log_name(name) == title.log; };
    if (std::any_of(benchmark.logs.begin(), benchmark.logs.end(),
                    [&](const LogIdentity& log) { return is_it(log.name); }))
      continue;
    const bool unrelated =
        std::any_of(benchmark.without_relations.begin(), benchmark.without_relations.end(), is_it);
    const bool left_out = std::any_of(benchmark.left_out.begin(), benchmark.left_out.end(), is_it);
    text += "- " + title.title + ": " +
            (unrelated  ? "its log is in the folder without relations, and was not mapped."
             : left_out ? "its log was not asked for, and was not mapped."
                        : "its log is not in the folder.") +
            '\n';
  }
  return text.empty() ? text : text + '\n';
}

Json cell_json(const FreiburgCell& cell) {
  Json failed = Json::array();
  for (const FreiburgResult& run : cell.runs)
    if (!run.figures) failed.push_back({{"seed", run.seed}, {"reason", run.failure}});
  Json json = {{"log", cell.log},
               {"matcher", cell.matcher},
               {"random", draws_random_numbers(cell.matcher)},
               {"runs", cell.runs.size() - failed.size()},
               {"failed", failed}};
  const auto figures = figures_of(cell);
  if (!figures) return json;
  for (std::size_t i = 0; i < kPathFigures.size(); ++i) {
    const MeanAndStd& errors = figures->errors.*kPathFigures[i].errors;
    const SeedSpread& spread = figures->spread[i];
    json[kPathFigures[i].key] = {
        {"mean", errors.mean},
        {"std", errors.std},
        {"over_seeds", {{"std", spread.std}, {"min", spread.min}, {"max", spread.max}}}};
  }
  json["relations_used"] = figures->relations_used;
  json["relations_skipped"] = figures->relations_skipped;
  json["loops_accepted"] = spread_json(figures->loops_accepted);
  json["loops_judged"] = spread_json(figures->loops_judged);
  json["loops_false"] = spread_json(figures->loops_false);
  json["loop_recall"] = figures->loop_recall ? spread_json(*figures->loop_recall) : Json(nullptr);
  json["wall_s"] = spread_json(figures->wall_s);
  json["cpu_s"] = spread_json(figures->cpu_s);
  json["real_time_factor"] = spread_json(figures->real_time_factor);
  json["peak_memory_mib"] = spread_json(figures->peak_memory_mib);
  return json;
}

Json comparison_json(const Comparison& comparison) {
  Json rows = Json::array();
  for (const ComparisonRow& row : comparison.rows) {
    Json systems = Json::array();
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      if (!row.values[i]) continue;
      const PublishedFigure& value = *row.values[i];
      systems.push_back({{"system", comparison.columns[i].name},
                         {"mean", value.mean},
                         {"std", value.std ? Json(*value.std) : Json(nullptr)},
                         {"unchecked", value.unchecked},
                         {"failed_runs", comparison.columns[i].ours ? row.failed : 0},
                         {"best", static_cast<bool>(row.best[i])}});
    }
    rows.push_back({{"log", row.log}, {"figure", kPathFigures[row.figure].key}, {"systems", systems}});
  }
  return rows;
}

}  // namespace

std::string freiburg_markdown(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                              const std::string& machine) {
  const Comparison comparison = compare_with_others(benchmark);
  std::string text = "# Freiburg benchmark\n\n";
  text += measured_by(machine) + ", " + (options.processes == 1 ? "" : "at most ") +
          std::to_string(options.processes) + (options.processes == 1 ? " run" : " runs") +
          " at a time with " + std::to_string(options.threads) +
          (options.threads == 1 ? " thread" : " threads") + " each, " + seeds_text(options.seeds) + ".\n\n";
  text +=
      "- errors: metric of Kümmerle et al. 2009 over all true relations, mean ± standard deviation over the "
      "relations; means over the seeds, never the best seed\n"
      "- Cartographer's variant of the translational error is what the tool of Hess et al. computes\n"
      "- false of judged: of the accepted loops, those that the true relations contradict, of those that a "
      "relation speaks of; recall: of the relations that join two passes of a place, those whose "
      "neighbourhoods a loop joins; means over the seeds\n"
      "- times and memory: of the whole process that reads the log, maps it and evaluates the path; no map "
      "is "
      "drawn; × real time: the recording's length over wall time\n\n";
  text += "## Ours beside the others\n\n" + comparison_table(comparison) +
          "\nBold is the least mean of each row. Systems marked live or run here were mapped on these "
          "logs; maps that were lost keep their figures. Where the figures come from:\n\n" +
          sources_text(comparison) + '\n' + missing_text(benchmark);
  text += baselines_markdown(benchmark);
  text += "## Every matcher on every log\n\n" + matchers_table(benchmark) + '\n';
  text +=
      "## Spread of the means over the seeds\n\nStandard deviation of the sample (least – most); – where a "
      "single run tells nothing of it.\n\n" +
      spread_table(benchmark) + '\n';
  text += failures_text(benchmark) + logs_markdown(benchmark.logs, benchmark.without_relations);
  return text;
}

std::string freiburg_json(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                          const std::string& machine) {
  Json logs = Json::array();
  for (const LogIdentity& log : benchmark.logs) logs.push_back(log_json(log));
  Json cells = Json::array();
  for (const FreiburgCell& cell : benchmark.cells) cells.push_back(cell_json(cell));
  const Json json = {{"schema", "psi-slam-freiburg-benchmark"},
                     {"schema_version", 1},
                     {"program_version", program_version()},
                     {"commit", program_commit()},
                     {"machine", machine},
                     {"seeds", options.seeds.all()},
                     {"processes", options.processes},
                     {"threads", options.threads},
                     {"logs", logs},
                     {"cells", cells},
                     {"rivals", baselines_json(benchmark)},
                     {"comparison", comparison_json(compare_with_others(benchmark))}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace psi_slam
