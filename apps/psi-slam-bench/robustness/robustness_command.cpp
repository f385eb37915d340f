// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "common/bench_command.h"
#include "match/match_report.h"
#include "base/atomic_file.h"
#include "batch/machine_text.h"
#include "robustness/robustness_benchmark.h"
#include "robustness/robustness_report.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct RobustnessArguments {
  DataArguments data;
  OutputArguments output;
  std::vector<std::string> logs;
  SeedRange seeds;
};

void run_robustness(const RobustnessArguments& arguments, const Streams& streams) {
  const ChosenLogs chosen = chosen_logs(arguments.data, arguments.logs);
  check_outputs(arguments.output, "robustness.md");
  RobustnessBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
    return run_robustness_benchmark(chosen.logs, arguments.seeds, progress);
  });
  benchmark.without_relations = chosen.without_relations;

  const std::string machine = machine_text();
  const std::string page = robustness_markdown(benchmark, arguments.seeds, machine);
  if (!arguments.output.json.empty())
    write_text_atomically(arguments.output.json, robustness_json(benchmark, arguments.seeds, machine));
  if (!arguments.output.output.empty()) {
    const fs::path folder = arguments.output.output;
    write_text_atomically(folder / "robustness.md", page);
    for (const RobustnessPlot& plot : robustness_plots(benchmark))
      write_text_atomically(folder / plot.file, plot.svg);
  }
  print_page(page, streams);
}

}  // namespace

void add_robustness_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<RobustnessArguments>();
  CLI::App* const command =
      app.add_subcommand("robustness", "Make real logs worse, and see what is made of them");
  add_data_options(*command, arguments->data);
  add_logs_option(*command, arguments->logs);
  add_seeds_option(*command, arguments->seeds, "Of the noise");
  add_output_options(*command, arguments->output, "robustness.md and the plots");
  command->callback([arguments, &streams] { run_robustness(*arguments, streams); });
}

}  // namespace psi_slam
