// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "batch/provenance.h"
#include "common/bench_command.h"
#include "match/match_report.h"

namespace psi_slam {
namespace {

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
  write_report(match_report(benchmark, arguments.options, machine_text()), arguments.output, streams);
}

}  // namespace

void add_match_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<MatchArguments>();
  CLI::App* const match = app.add_subcommand("match", "Compare the matchers on loops drawn from real logs");
  add_data_options(*match, arguments->data);
  match
      ->add_option("--cases", arguments->options.cases,
                   "Number of positive cases from each log, and of negative ones")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_seed_option(*match, arguments->options.seed, "Seed of the cases and of the random matchers");
  match->add_flag("--windows", arguments->options.windows,
                  "Also compare the matchers over window sizes and over sizes of local maps");
  add_output_options(*match, arguments->output, "match.md and the plots");
  match->callback([arguments, &streams] { run_match(*arguments, streams); });
}

}  // namespace psi_slam
