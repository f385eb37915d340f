// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "robustness/robustness_benchmark.h"

namespace psi_slam {

void add_robustness_command(CLI::App& app, const Streams& streams) {
  struct Arguments {
    DataArguments data;
    OutputArguments output;
    SeedRange seeds;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      app.add_subcommand("robustness", "Degrade real logs and measure the errors of their maps");
  add_data_options(*command, arguments->data);
  add_logs_option(*command, arguments->data);
  add_seeds_option(*command, arguments->seeds, "Seeds of the odometry noise");
  add_output_options(*command, arguments->output, "robustness.md and the plots");
  command->callback([arguments, &streams] {
    const ChosenLogs chosen = chosen_logs(arguments->data, streams);
    check_outputs(arguments->output, "robustness.md");
    RobustnessBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
      return run_robustness_benchmark(chosen.logs, arguments->seeds, progress);
    });
    benchmark.without_relations = chosen.without_relations;
    write_report(robustness_report(benchmark, arguments->seeds, machine_text()), arguments->output, streams);
  });
}

}  // namespace psi_slam
