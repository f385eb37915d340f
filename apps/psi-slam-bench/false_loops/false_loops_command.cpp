// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "false_loops/false_loop_benchmark.h"

namespace psi_slam {

void add_false_loops_command(CLI::App& app, const Streams& streams) {
  struct Arguments {
    DataArguments data;
    OutputArguments output;
    FalseLoopBenchmarkOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "false-loops", "Add false loops to the graphs of real logs and measure the errors of the maps");
  add_data_options(*command, arguments->data);
  add_logs_option(*command, arguments->data);
  command
      ->add_option("--shares", arguments->options.shares_percent,
                   "Numbers of false loops in percent of the true loops, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10'000.0))
      ->capture_default_str()
      ->type_name("PERCENTS");
  add_seeds_option(*command, arguments->options.seeds, "Seeds of the false loops");
  add_output_options(*command, arguments->output, "false-loops.md and the plots");
  command->callback([arguments, &streams] {
    const ChosenLogs chosen = chosen_logs(arguments->data, streams);
    check_outputs(arguments->output, "false-loops.md");
    FalseLoopBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
      return run_false_loop_benchmark(chosen.logs, arguments->options, progress);
    });
    benchmark.without_relations = chosen.without_relations;
    write_report(false_loop_report(benchmark, arguments->options, machine_text()), arguments->output,
                 streams);
  });
}

}  // namespace psi_slam
