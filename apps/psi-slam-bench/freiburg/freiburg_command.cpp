// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <ostream>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "interrupt_signals.h"
#include "map/report/html_text.h"
#include "number_between.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct FreiburgArguments : BenchArguments {
  FreiburgOptions options;
  bool baselines = false;
  double baseline_limit_s = BaselineOptions().time_limit_s;
};

/// Throws UserError for a name that occurs twice.
void check_once(const std::vector<std::string>& names, const std::string& option) {
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      throw UserError(option + ": " + *name + " is named twice: name it once");
}

/// Finds the installed baselines if --baselines is given. Prints a warning for each missing baseline. Throws
/// UserError when all are missing.
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
  const ChosenLogs chosen = chosen_logs(arguments, streams);
  check_outputs(arguments, "freiburg.md");
  arguments.options.output = arguments.output;
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

  write_report(freiburg_report(benchmark, arguments.options, machine_text()), arguments, streams);
  std::size_t without_path = 0;
  for (const BaselineResult& baseline : benchmark.baseline_results) without_path += baseline.figures ? 0 : 1;
  if (without_path > 0)
    streams.err << "psi-slam-bench: " << counted(without_path, "run", "runs")
                << " of baselines gave no path: the page lists them with their reasons\n";
  std::size_t failed = 0;
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& run : cell.runs) failed += run.figures ? 0 : 1;
  if (failed > 0)
    throw SystemFailure(counted(failed, "run", "runs") + " failed: the page lists them with their reasons");
}

}  // namespace

void add_freiburg_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<FreiburgArguments>();
  FreiburgOptions& options = arguments->options;
  arguments->output = "out/freiburg";
  CLI::App& freiburg = *app.add_subcommand(
      "freiburg", "Map the logs of the Freiburg benchmark and compare with other systems");
  add_data_options(freiburg, *arguments);
  add_output_options(freiburg, *arguments,
                     "freiburg.md, the plots and the results of runs, which are not repeated");
  add_seeds_option(freiburg, options.seeds, "Seeds of the runs of each random matcher");
  freiburg
      .add_option("--matchers", options.matchers,
                  "Matchers to run, of csm, csm_ga, ga, adaptive and adaptive_paper; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(freiburg_matchers()))
      ->type_name("NAMES");
  add_logs_option(freiburg, *arguments);
  freiburg.add_option("--threads", options.threads, "Number of threads of each run")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  freiburg
      .add_option("--processes", options.processes,
                  "Number of runs at a time; measured times are only meaningful with 1")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  CLI::Option* const baselines = freiburg.add_flag(
      "--baselines", arguments->baselines,
      "Also run MRPT's icp-slam and rbpf-slam, if they are on PATH, with their shipped settings");
  freiburg
      .add_option("--baseline-limit-s", arguments->baseline_limit_s,
                  "Seconds after which the run of a baseline is stopped")
      ->needs(baselines)
      ->check(number_between(0.1, 1e6))
      ->capture_default_str();
  freiburg.callback([=, &streams] { run_freiburg(*arguments, streams); });
}

void add_freiburg_run_command(CLI::App& app, const Streams& streams) {
  const auto run = std::make_shared<FreiburgRun>();
  CLI::App& once = *app.add_subcommand("freiburg-run", "One run of the Freiburg benchmark");
  once.group("");  // hidden: only the freiburg command calls it
  once.add_option("--log", run->log)->required();
  once.add_option("--ini", run->ini)->required();
  once.add_option("--relations", run->relations)->required();
  once.add_option("--matcher", run->matcher)->required()->check(CLI::IsMember(freiburg_matchers()));
  once.add_option("--seed", run->seed);
  once.add_option("--threads", run->threads);
  once.callback([run, &streams] {
    streams.out << figures_json(map_and_evaluate(*run)) << std::endl;
    if (!streams.out) throw SystemFailure("cannot write to standard output");
  });
}

}  // namespace psi_slam
