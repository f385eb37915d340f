// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <ostream>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "freiburg/baseline_run.h"
#include "freiburg/freiburg_benchmark.h"
#include "interrupt_signals.h"
#include "psi_slam/user_error.h"
#include "report/html_text.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct FreiburgArguments {
  DataArguments data;
  OutputArguments output{{}, {}, "out/freiburg"};
  FreiburgOptions options;
  bool baselines = false;
  double baseline_limit_s = BaselineOptions().time_limit_s;
};

/// Throws UserError for a name that occurs twice.
void check_once(const std::vector<std::string>& names, const std::string& option) {
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      throw UserError(option + ": " + *name + " is named twice");
}

std::size_t failed_runs(const FreiburgBenchmark& benchmark) {
  std::size_t failed = 0;
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& run : cell.runs) failed += run.figures ? 0 : 1;
  return failed;
}

/// Number of runs of baselines that gave no path within the time limit.
std::size_t failed_baselines(const FreiburgBenchmark& benchmark) {
  return static_cast<std::size_t>(
      std::count_if(benchmark.baseline_results.begin(), benchmark.baseline_results.end(),
                    [](const BaselineResult& baseline) { return !baseline.figures; }));
}

/// The installed baselines if --baselines is given, with a warning for each missing one. Throws UserError
/// when all are missing.
FoundBaselines baselines_of(const FreiburgArguments& arguments, const Streams& streams) {
  if (!arguments.baselines) return {};
  const char* const search_path = std::getenv("PATH");
  FoundBaselines baselines = find_baselines(search_path != nullptr ? search_path : "");
  if (baselines.programs.empty()) {
    std::string why;
    for (const std::string& missing : baselines.missing) why += (why.empty() ? "" : ", ") + missing;
    throw UserError("--baselines: " + why + "; install Debian's package mrpt-apps");
  }
  for (const std::string& missing : baselines.missing)
    streams.err << "psi-slam-bench: warning: --baselines: " << missing << '\n';
  return baselines;
}

void run_freiburg(FreiburgArguments arguments, const Streams& streams) {
  check_once(arguments.options.matchers, "--matchers");
  const ChosenLogs chosen = chosen_logs(arguments.data, streams);
  check_outputs(arguments.output, "freiburg.md");
  arguments.options.output = arguments.output.output;
  prepare_folder(arguments.options.output / "runs", "any.json");
  const FoundBaselines baselines = baselines_of(arguments, streams);
  FreiburgBenchmark benchmark = with_progress(streams, [&](const auto& progress) {
    const InterruptSignals signals;
    FreiburgBenchmark ours = run_freiburg_benchmark(chosen.logs, arguments.options, signals.came(), progress);
    ours.baseline_results =
        run_baselines(baselines.programs, chosen.logs,
                      {arguments.baseline_limit_s, arguments.options.processes, arguments.options.output},
                      signals.came(), progress);
    return ours;
  });
  benchmark.baselines = baselines;
  benchmark.without_relations = chosen.without_relations;
  benchmark.left_out = chosen.left_out;

  write_report(freiburg_report(benchmark, arguments.options, machine_text()), arguments.output, streams);
  if (const std::size_t failed = failed_baselines(benchmark); failed > 0)
    streams.err << "psi-slam-bench: " << counted(failed, "run", "runs")
                << " of baselines gave no path: the page lists them with their reasons\n";
  if (const std::size_t failed = failed_runs(benchmark); failed > 0)
    throw SystemFailure(counted(failed, "run", "runs") + " failed: the page lists them with their reasons");
}

/// Makes one run in this process and prints its figures. The benchmark starts a process for each run.
void run_once(const FreiburgRun& run, const Streams& streams) {
  streams.out << figures_json(map_and_evaluate(run)) << std::endl;
  if (!streams.out) throw SystemFailure("cannot write to standard output");
}

void add_work_options(CLI::App& freiburg, FreiburgArguments& arguments) {
  add_seeds_option(freiburg, arguments.options.seeds, "Seeds of the runs of each random matcher");
  freiburg
      .add_option("--matchers", arguments.options.matchers,
                  "Matchers to run, of csm, csm_ga, ga, adaptive and adaptive_paper; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(freiburg_matchers()))
      ->type_name("NAME,...");
  add_logs_option(freiburg, arguments.data);
  freiburg.add_option("--threads", arguments.options.threads, "Number of threads of each run")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

/// The options for runs on this machine.
void add_local_options(CLI::App& freiburg, FreiburgArguments& arguments) {
  freiburg
      .add_option("--processes", arguments.options.processes,
                  "Number of runs at a time; measured times are only meaningful with 1")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  constexpr double kMost_s = 1e6;
  CLI::Option* const baselines = freiburg.add_flag(
      "--baselines", arguments.baselines,
      "Also run MRPT's icp-slam and rbpf-slam, if they are on PATH, with their shipped settings");
  freiburg
      .add_option("--baseline-limit-s", arguments.baseline_limit_s,
                  "Seconds after which the run of a baseline is stopped")
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
  CLI::App* const freiburg =
      app.add_subcommand("freiburg", "Map the logs of the Freiburg benchmark and compare with other systems");
  add_data_options(*freiburg, arguments->data);
  add_output_options(*freiburg, arguments->output,
                     "freiburg.md, the plots and the results of runs, which are not repeated");
  add_work_options(*freiburg, *arguments);
  if (!work.workers) add_local_options(*freiburg, *arguments);
  freiburg->callback([arguments, &streams, only_parsed = work.only_parsed] {
    if (!only_parsed) run_freiburg(*arguments, streams);
  });
}

void add_freiburg_run_command(CLI::App& app, const Streams& streams) {
  const auto run = std::make_shared<FreiburgRun>();
  CLI::App* const once = app.add_subcommand("freiburg-run", "One run of the Freiburg benchmark");
  once->group("");  // hidden: only the freiburg command calls it
  once->add_option("--log", run->log)->required();
  once->add_option("--ini", run->ini)->required();
  once->add_option("--relations", run->relations)->required();
  once->add_option("--matcher", run->matcher)->required()->check(CLI::IsMember(freiburg_matchers()));
  once->add_option("--seed", run->seed);
  once->add_option("--threads", run->threads);
  once->callback([run, &streams] { run_once(*run, streams); });
}

}  // namespace psi_slam
