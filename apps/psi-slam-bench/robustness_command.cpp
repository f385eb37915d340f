// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bench_command.h"
#include "bench_progress.h"
#include "match_report.h"
#include "psi_slam/base/atomic_file.h"
#include "robustness_benchmark.h"
#include "robustness_report.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct RobustnessArguments {
  std::string data;
  std::string ini;
  std::string json;
  std::string output;
  std::vector<std::string> logs;
  std::uint64_t seed = 1;
};

void run_robustness(const RobustnessArguments& arguments, const Streams& streams) {
  const std::vector<BenchmarkLog> logs =
      chosen_logs(find_benchmark_logs(arguments.data, ini_folder(arguments.ini)), arguments.logs);
  if (!arguments.json.empty()) check_writable(arguments.json);
  if (!arguments.output.empty()) prepare_folder(arguments.output, "robustness.md");
  BenchProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  const RobustnessBenchmark benchmark = run_robustness_benchmark(
      logs, arguments.seed,
      [&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
  progress.clear();

  const std::string machine = machine_text();
  const std::string page = robustness_markdown(benchmark, arguments.seed, machine);
  if (!arguments.json.empty())
    write_text_atomically(arguments.json, robustness_json(benchmark, arguments.seed, machine));
  if (!arguments.output.empty()) {
    const fs::path folder = arguments.output;
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
  command->add_option("--data", arguments->data, "Folder of the logs: NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--ini", arguments->ini, "Folder of their settings NAME.ini; default: those of psi-slam")
      ->type_name("DIR");
  command->add_option("--logs", arguments->logs, "Only these, by name, commas in between")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_option("--seed", arguments->seed, "Of the noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--json", arguments->json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for robustness.md and the plots; those that are there are replaced")
      ->type_name("DIR");
  command->callback([arguments, &streams] { run_robustness(*arguments, streams); });
}

}  // namespace psi_slam
