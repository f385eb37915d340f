// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "match/match_benchmark.h"

namespace psi_slam {

void add_match_command(CLI::App& app, const Streams& streams) {
  struct Arguments {
    DataArguments data;
    OutputArguments output;
    MatchBenchmarkOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  MatchBenchmarkOptions& options = arguments->options;
  CLI::App* const match = app.add_subcommand("match", "Compare the matchers on loops drawn from real logs");
  add_data_options(*match, arguments->data);
  match->add_option("--cases", options.cases, "Number of positive cases from each log, and of negative ones")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_seed_option(*match, options.seed, "Seed of the cases and of the random matchers");
  match->add_flag("--windows", options.windows,
                  "Also compare the matchers over window sizes and over sizes of local maps");
  add_output_options(*match, arguments->output, "match.md and the plots");
  match->callback([arguments, &streams] {
    const std::vector<BenchmarkLog> logs = logs_of(arguments->data);
    check_outputs(arguments->output, "match.md");
    const MatchBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
      return run_match_benchmark(logs, arguments->options, progress);
    });
    write_report(match_report(benchmark, arguments->options, machine_text()), arguments->output, streams);
  });
}

}  // namespace psi_slam
