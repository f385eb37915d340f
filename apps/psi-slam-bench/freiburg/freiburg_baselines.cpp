// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_baselines.h"

#include <nlohmann/json.hpp>

#include "batch/markdown_cells.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kOtherFigures = 5;

std::string row_text(const BaselineResult& result) {
  std::string text = "| " + result.log + " | " + result.baseline + " | ";
  if (!result.figures) {
    const std::string why = result.not_finished_in_s
                                ? "not finished in " + fixed_text(*result.not_finished_in_s, 0) + " s"
                                : "failed: " + cell_text(result.failure);
    return text + why + repeated(" | –", kPathFigures.size() + kOtherFigures - 1) + " |\n";
  }
  for (const PathFigure& figure : kPathFigures)
    text += errors_text(result.figures->errors.*figure.errors) + " | ";
  return text + std::to_string(result.figures->relations_used) + " | " +
         fixed_text(result.figures->wall_s, 2) + " | " + fixed_text(result.figures->cpu_s, 2) + " | " +
         fixed_text(result.figures->real_time_factor(), 0) + " | " +
         fixed_text(result.figures->peak_memory_mib, 0) + " |\n";
}

std::string results_table(const FreiburgBenchmark& benchmark) {
  if (benchmark.baseline_results.empty()) return {};
  std::string text = "| log | system |" + path_figure_heads() +
                     " relations used | wall [s] | CPU [s] | × real time | peak [MiB] |\n|---|---|" +
                     repeated("---:|", kPathFigures.size() + kOtherFigures) + '\n';
  for (const BaselineResult& result : benchmark.baseline_results) text += row_text(result);
  return text + '\n';
}

}  // namespace

std::string baselines_markdown(const FreiburgBenchmark& benchmark) {
  if (benchmark.baselines.programs.empty() && benchmark.baselines.missing.empty()) return {};
  std::string text = "## Baselines, live\n\n";
  for (const BaselineProgram& baseline : benchmark.baselines.programs)
    text += "- " + baseline.kind.name + ": " + baseline.version + ", with " + baseline.config.string() +
            " as it ships but for the folder of its output and " + changes_text(baseline.kind) + '\n';
  for (const std::string& missing : benchmark.baselines.missing) text += "- not run: " + missing + '\n';
  return text +
         "\nEach was given every scan of the log as our own reader has it, with the odometry in between and "
         "the same mount of the laser, and ran once. Times and memory: of its whole process, which reads the "
         "log, maps it and writes path and map.\n\n" +
         results_table(benchmark);
}

Json baselines_json(const FreiburgBenchmark& benchmark) {
  Json programs = Json::array();
  for (const BaselineProgram& baseline : benchmark.baselines.programs)
    programs.push_back({{"rival", baseline.kind.name},
                        {"version", baseline.version},
                        {"sha256", baseline.sha256},
                        {"config", baseline.config.string()},
                        {"changes", changes_text(baseline.kind)}});
  Json runs = Json::array();
  for (const BaselineResult& result : benchmark.baseline_results) {
    Json run = {{"log", result.log}, {"rival", result.baseline}};
    if (result.figures) run["figures"] = run_figures_json(*result.figures);
    if (result.not_finished_in_s) run["not_finished_in_s"] = *result.not_finished_in_s;
    if (!result.failure.empty()) run["failure"] = result.failure;
    runs.push_back(run);
  }
  return {{"programs", programs}, {"missing", benchmark.baselines.missing}, {"runs", runs}};
}

}  // namespace psi_slam
