// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bench_command.h"
#include "bench_progress.h"
#include "benchmark_logs.h"
#include "match_benchmark.h"
#include "match_report.h"
#include "psi_slam/base/atomic_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct MatchArguments {
  std::string data;
  std::string ini;
  std::string json;
  std::string output;
  MatchBenchmarkOptions options;
};

void run_match(const MatchArguments& arguments, const Streams& streams) {
  const std::vector<BenchmarkLog> logs = find_benchmark_logs(arguments.data, ini_folder(arguments.ini));
  if (!arguments.json.empty()) check_writable(arguments.json);
  if (!arguments.output.empty()) prepare_folder(arguments.output, "match.md");
  BenchProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  const MatchBenchmark benchmark = run_match_benchmark(
      logs, arguments.options,
      [&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
  progress.clear();

  const std::string machine = machine_text();
  const std::string page = match_markdown(benchmark, arguments.options, machine);
  if (!arguments.json.empty())
    write_text_atomically(arguments.json, match_json(benchmark, arguments.options, machine));
  if (!arguments.output.empty()) {
    const fs::path folder = arguments.output;
    write_text_atomically(folder / "match.md", page);
    if (arguments.options.windows) {
      write_text_atomically(folder / "match-windows.svg", window_plot(benchmark));
      write_text_atomically(folder / "match-local-maps.svg", local_map_plot(benchmark));
    }
  }
  print_page(page, streams);
}

}  // namespace

void add_match_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<MatchArguments>();
  CLI::App* const match = app.add_subcommand("match", "Compare the matchers on loops drawn from real logs");
  match->add_option("--data", arguments->data, "Folder of the logs: NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  match->add_option("--ini", arguments->ini, "Folder of their settings NAME.ini; default: those of psi-slam")
      ->type_name("DIR");
  match
      ->add_option("--json", arguments->json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  match
      ->add_option("--cases", arguments->options.cases,
                   "Positive cases from each log, and as many negative ones")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  match->add_option("--seed", arguments->options.seed, "Of the cases and of the random matchers")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  match->add_flag("--windows", arguments->options.windows,
                  "Also compare over window sizes and sizes of local maps");
  match
      ->add_option("-o,--output", arguments->output,
                   "Folder for match.md and the plots; those that are there are replaced")
      ->type_name("DIR");
  match->callback([arguments, &streams] { run_match(*arguments, streams); });
}

}  // namespace psi_slam
