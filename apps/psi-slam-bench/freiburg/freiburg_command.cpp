// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <ostream>

#include "common/bench_command.h"
#include "freiburg/freiburg_comparison.h"
#include "freiburg/freiburg_report.h"
#include "interrupt_signals.h"
#include "match/match_report.h"
#include "base/atomic_file.h"
#include "psi_slam/user_error.h"
#include "batch/machine_text.h"
#include "freiburg/published_figures.h"
#include "freiburg/baseline_benchmark.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPage = "freiburg.md";

struct FreiburgArguments {
  DataArguments data;
  std::string json;
  std::string output = "out/freiburg";
  std::vector<std::string> names;  ///< of logs; empty: all
  FreiburgOptions options;
  bool baselines = false;
  double baseline_limit_s = BaselineOptions().time_limit_s;
};

/// Throws UserError when a name is there twice.
void check_once(const std::vector<std::string>& names, const std::string& option) {
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      throw UserError(option + ": " + *name + " is named twice");
}

void write_files(const FreiburgArguments& arguments, const FreiburgBenchmark& benchmark,
                 const std::string& page, const std::string& machine) {
  const fs::path folder = arguments.output;
  if (!arguments.json.empty())
    write_text_atomically(arguments.json, freiburg_json(benchmark, arguments.options, machine));
  write_text_atomically(folder / kPage, page);
  const Comparison comparison = compare_with_others(benchmark);
  for (const LogIdentity& log : benchmark.logs) {
    const std::string plot = comparison_plot(comparison, benchmark_log_title(log.name));
    if (!plot.empty()) write_text_atomically(folder / ("freiburg-" + log.name + ".svg"), plot);
  }
}

std::size_t failed_runs(const FreiburgBenchmark& benchmark) {
  std::size_t failed = 0;
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& run : cell.runs) failed += run.figures ? 0 : 1;
  return failed;
}

/// How many baselines came to no path, in the time that they had.
std::size_t failed_baselines(const FreiburgBenchmark& benchmark) {
  return static_cast<std::size_t>(std::count_if(benchmark.baseline_results.begin(),
                                                benchmark.baseline_results.end(),
                                                [](const BaselineResult& baseline) { return !baseline.figures; }));
}

/// Those that were asked for; the missing ones are told. Throws UserError when all are missing.
FoundBaselines baselines_of(const FreiburgArguments& arguments, const Streams& streams) {
  if (!arguments.baselines) return {};
  const char* const search_path = std::getenv("PATH");
  FoundBaselines baselines = find_baselines(search_path != nullptr ? search_path : "");
  if (baselines.programs.empty()) {
    std::string why;
    for (const std::string& missing : baselines.missing) why += (why.empty() ? "" : ", ") + missing;
    throw UserError("--baselines: " + why + "; Debian's package mrpt-apps has them");
  }
  for (const std::string& missing : baselines.missing)
    streams.err << "psi-slam-bench: warning: --baselines: " << missing << '\n';
  return baselines;
}

BaselineOptions baseline_options(const FreiburgArguments& arguments) {
  return {arguments.baseline_limit_s, arguments.options.processes, arguments.options.output};
}

void run_freiburg(FreiburgArguments arguments, const Streams& streams) {
  check_once(arguments.options.matchers, "--matchers");
  const ChosenLogs chosen = chosen_logs(arguments.data, arguments.names);
  for (const BenchmarkLog& log : chosen.logs)
    benchmark_settings(log.ini);  // wrong ones are told before the work
  if (!arguments.json.empty()) check_writable(arguments.json);
  prepare_folder(arguments.output, kPage);
  prepare_folder(fs::path(arguments.output) / "runs", "any.json");
  arguments.options.output = arguments.output;
  const FoundBaselines baselines = baselines_of(arguments, streams);
  FreiburgBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
    const InterruptSignals signals;
    FreiburgBenchmark ours = run_freiburg_benchmark(chosen.logs, arguments.options, signals.came(), progress);
    ours.baseline_results =
        run_baselines(baselines.programs, chosen.logs, baseline_options(arguments), signals.came(), progress);
    return ours;
  });
  benchmark.baselines = baselines;
  benchmark.without_relations = chosen.without_relations;
  benchmark.left_out = chosen.left_out;

  const std::string machine = machine_text();
  const std::string page = freiburg_markdown(benchmark, arguments.options, machine);
  write_files(arguments, benchmark, page, machine);
  print_page(page, streams);
  if (const std::size_t failed = failed_baselines(benchmark); failed > 0)
    streams.err << "psi-slam-bench: of the baselines' runs " << failed
                << " came to nothing: the page says which and why\n";
  if (const std::size_t failed = failed_runs(benchmark); failed > 0)
    throw SystemFailure(std::to_string(failed) + (failed == 1 ? " run" : " runs") +
                        " failed: the page says which and why");
}

/// A run in this process, its figures on standard output: what the benchmark starts processes for.
void run_once(const FreiburgRun& run, const Streams& streams) {
  streams.out << figures_json(map_and_evaluate(run)) << std::endl;
  if (!streams.out) throw SystemFailure("cannot write to standard output");
}

void add_processes_option(CLI::App& freiburg, FreiburgArguments& arguments) {
  freiburg
      .add_option("--processes", arguments.options.processes, "Runs at a time; more than 1 spoils the times")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void add_work_options(CLI::App& freiburg, FreiburgArguments& arguments) {
  add_seeds_option(freiburg, arguments.options.seeds, "Of the runs of each random matcher");
  freiburg
      .add_option("--matchers", arguments.options.matchers,
                  "Which of csm, csm_ga, ga, adaptive and adaptive_paper; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(freiburg_matchers()))
      ->type_name("NAME,...");
  add_logs_option(freiburg, arguments.names);
  freiburg.add_option("--threads", arguments.options.threads, "Threads of each run")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void add_baseline_options(CLI::App& freiburg, FreiburgArguments& arguments) {
  CLI::Option* const baselines = freiburg.add_flag(
      "--baselines", arguments.baselines,
      "Run MRPT's icp-slam and rbpf-slam too, where they are on PATH, with the settings that they ship with");
  constexpr double kMost_s = 1e6;
  freiburg.add_option("--baseline-limit-s", arguments.baseline_limit_s, "Seconds after which a baseline is stopped")
      ->needs(baselines)
      ->check(CLI::Range(0.1, kMost_s))
      ->capture_default_str();
}

}  // namespace

void add_freiburg_command(CLI::App& app, const Streams& streams, const FreiburgWork& work) {
  const auto arguments = std::make_shared<FreiburgArguments>();
  arguments->options.program = work.program;
  arguments->options.workers = work.workers;
  arguments->options.processes = work.runs_at_a_time;
  CLI::App* const freiburg = app.add_subcommand(
      "freiburg", "Map the logs of the Freiburg benchmark, and compare with what others reached");
  add_data_options(*freiburg, arguments->data);
  freiburg
      ->add_option("--json", arguments->json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  freiburg
      ->add_option("-o,--output", arguments->output,
                   "Folder for freiburg.md, the plots and the runs; runs that are there are not made again")
      ->type_name("DIR")
      ->capture_default_str();
  add_work_options(*freiburg, *arguments);
  if (!work.workers) {
    add_processes_option(*freiburg, *arguments);
    add_baseline_options(*freiburg, *arguments);
  }
  freiburg->callback([arguments, &streams, only_parsed = work.only_parsed] {
    if (!only_parsed) run_freiburg(*arguments, streams);
  });
}

void add_freiburg_run_command(CLI::App& app, const Streams& streams) {
  const auto run = std::make_shared<FreiburgRun>();
  CLI::App* const once = app.add_subcommand("freiburg-run", "One run of the Freiburg benchmark");
  once->group("");  // not for people: hidden from --help
  once->add_option("--log", run->log)->required();
  once->add_option("--ini", run->ini)->required();
  once->add_option("--relations", run->relations)->required();
  once->add_option("--matcher", run->matcher)->required()->check(CLI::IsMember(freiburg_matchers()));
  once->add_option("--seed", run->seed);
  once->add_option("--threads", run->threads);
  once->callback([run, &streams] { run_once(*run, streams); });
}

}  // namespace psi_slam
