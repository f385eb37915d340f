// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "common/bench_command.h"
#include "common/benchmark_logs.h"
#include "match/match_benchmark.h"
#include "match/match_report.h"
#include "base/atomic_file.h"
#include "batch/machine_text.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct MatchArguments {
  DataArguments data;
  OutputArguments output;
  MatchBenchmarkOptions options;
};

void run_match(const MatchArguments& arguments, const Streams& streams) {
  const std::vector<BenchmarkLog> logs = logs_of(arguments.data);
  check_outputs(arguments.output, "match.md");
  const MatchBenchmark benchmark = with_progress(
      streams, [&](const auto& progress) { return run_match_benchmark(logs, arguments.options, progress); });

  const std::string machine = machine_text();
  const std::string page = match_markdown(benchmark, arguments.options, machine);
  if (!arguments.output.json.empty())
    write_text_atomically(arguments.output.json, match_json(benchmark, arguments.options, machine));
  if (!arguments.output.output.empty()) {
    const fs::path folder = arguments.output.output;
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
  add_data_options(*match, arguments->data);
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
  add_output_options(*match, arguments->output, "match.md and the plots");
  match->callback([arguments, &streams] { run_match(*arguments, streams); });
}

}  // namespace psi_slam
