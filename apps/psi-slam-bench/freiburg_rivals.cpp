// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg_rivals.h"

#include <nlohmann/json.hpp>

#include "batch/markdown_cells.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kOtherFigures = 5;

std::string row_text(const RivalResult& result) {
  std::string text = "| " + result.log + " | " + result.rival + " | ";
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
  if (benchmark.rival_results.empty()) return {};
  std::string text = "| log | system |" + path_figure_heads() +
                     " relations used | wall [s] | CPU [s] | × real time | peak [MiB] |\n|---|---|" +
                     repeated("---:|", kPathFigures.size() + kOtherFigures) + '\n';
  for (const RivalResult& result : benchmark.rival_results) text += row_text(result);
  return text + '\n';
}

}  // namespace

std::string rivals_markdown(const FreiburgBenchmark& benchmark) {
  if (benchmark.rivals.programs.empty() && benchmark.rivals.missing.empty()) return {};
  std::string text = "## Rivals, live\n\n";
  for (const RivalProgram& rival : benchmark.rivals.programs)
    text += "- " + rival.kind.name + ": " + rival.version + ", with " + rival.config.string() +
            " as it ships but for the folder of its output and " + changes_text(rival.kind) + '\n';
  for (const std::string& missing : benchmark.rivals.missing) text += "- not run: " + missing + '\n';
  return text +
         "\nEach was given every scan of the log as our own reader has it, with the odometry in between and "
         "the same mount of the laser, and ran once. Times and memory: of its whole process, which reads the "
         "log, maps it and writes path and map.\n\n" +
         results_table(benchmark);
}

Json rivals_json(const FreiburgBenchmark& benchmark) {
  Json programs = Json::array();
  for (const RivalProgram& rival : benchmark.rivals.programs)
    programs.push_back({{"rival", rival.kind.name},
                        {"version", rival.version},
                        {"sha256", rival.sha256},
                        {"config", rival.config.string()},
                        {"changes", changes_text(rival.kind)}});
  Json runs = Json::array();
  for (const RivalResult& result : benchmark.rival_results) {
    Json run = {{"log", result.log}, {"rival", result.rival}};
    if (result.figures) run["figures"] = run_figures_json(*result.figures);
    if (result.not_finished_in_s) run["not_finished_in_s"] = *result.not_finished_in_s;
    if (!result.failure.empty()) run["failure"] = result.failure;
    runs.push_back(run);
  }
  return {{"programs", programs}, {"missing", benchmark.rivals.missing}, {"runs", runs}};
}

}  // namespace psi_slam
