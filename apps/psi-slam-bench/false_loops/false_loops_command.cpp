// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "common/bench_command.h"
#include "false_loops/false_loop_benchmark.h"
#include "false_loops/false_loop_report.h"
#include "match/match_report.h"
#include "base/atomic_file.h"
#include "batch/machine_text.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct FalseLoopsArguments {
  DataArguments data;
  OutputArguments output;
  std::vector<std::string> logs;
  FalseLoopBenchmarkOptions options;
};

void run_false_loops(const FalseLoopsArguments& arguments, const Streams& streams) {
  const ChosenLogs chosen = chosen_logs(arguments.data, arguments.logs);
  check_outputs(arguments.output, "false-loops.md");
  FalseLoopBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
    return run_false_loop_benchmark(chosen.logs, arguments.options, progress);
  });
  benchmark.without_relations = chosen.without_relations;

  const std::string machine = machine_text();
  const std::string page = false_loop_markdown(benchmark, arguments.options, machine);
  if (!arguments.output.json.empty())
    write_text_atomically(arguments.output.json, false_loop_json(benchmark, arguments.options, machine));
  if (!arguments.output.output.empty()) {
    const fs::path folder = arguments.output.output;
    write_text_atomically(folder / "false-loops.md", page);
    for (const FalseLoopKind kind : arguments.options.kinds)
      write_text_atomically(folder / ("false-loops-" + name_of(kind) + ".svg"),
                            false_loop_plot(benchmark, kind));
  }
  print_page(page, streams);
}

}  // namespace

void add_false_loops_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<FalseLoopsArguments>();
  CLI::App* const command =
      app.add_subcommand("false-loops", "Add false loops to the graphs of real logs, and see what they do");
  add_data_options(*command, arguments->data);
  add_logs_option(*command, arguments->logs);
  command
      ->add_option("--shares", arguments->options.shares_percent,
                   "False loops in percent of the true ones, commas in between")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10'000.0))
      ->capture_default_str()
      ->type_name("PERCENTS");
  add_seeds_option(*command, arguments->options.seeds, "Of the false loops");
  add_output_options(*command, arguments->output, "false-loops.md and the plots");
  command->callback([arguments, &streams] { run_false_loops(*arguments, streams); });
}

}  // namespace psi_slam
