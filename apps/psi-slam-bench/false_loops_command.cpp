// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bench_command.h"
#include "bench_progress.h"
#include "false_loop_benchmark.h"
#include "false_loop_report.h"
#include "match_report.h"
#include "psi_slam/base/atomic_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct FalseLoopsArguments {
  std::string data;
  std::string ini;
  std::string json;
  std::string output;
  std::vector<std::string> logs;
  FalseLoopBenchmarkOptions options;
};

void run_false_loops(const FalseLoopsArguments& arguments, const Streams& streams) {
  const std::vector<BenchmarkLog> logs =
      chosen_logs(find_benchmark_logs(arguments.data, ini_folder(arguments.ini)), arguments.logs);
  if (!arguments.json.empty()) check_writable(arguments.json);
  if (!arguments.output.empty()) prepare_folder(arguments.output, "false-loops.md");
  BenchProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  const FalseLoopBenchmark benchmark = run_false_loop_benchmark(
      logs, arguments.options,
      [&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
  progress.clear();

  const std::string machine = machine_text();
  const std::string page = false_loop_markdown(benchmark, arguments.options, machine);
  if (!arguments.json.empty())
    write_text_atomically(arguments.json, false_loop_json(benchmark, arguments.options, machine));
  if (!arguments.output.empty()) {
    const fs::path folder = arguments.output;
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
  command->add_option("--data", arguments->data, "Folder of the logs: NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--ini", arguments->ini, "Folder of their settings NAME.ini; default: those of psi-slam")
      ->type_name("DIR");
  command->add_option("--logs", arguments->logs, "Only these, by name, commas in between")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--shares", arguments->options.shares_percent,
                   "False loops in percent of the true ones, commas in between")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10'000.0))
      ->capture_default_str()
      ->type_name("PERCENTS");
  command->add_option("--seed", arguments->options.seed, "Of the false loops")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--json", arguments->json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for false-loops.md and the plots; those that are there are replaced")
      ->type_name("DIR");
  command->callback([arguments, &streams] { run_false_loops(*arguments, streams); });
}

}  // namespace psi_slam
