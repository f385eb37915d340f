// SPDX-License-Identifier: BSD-3-Clause
#include "bench_app.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <ostream>
#include <utility>

#include "base/exit_code.h"
#include "base/text_parts.h"
#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "document_options.h"
#include "false_loops/false_loop_benchmark.h"
#include "live/live_benchmark.h"
#include "match/match_benchmark.h"
#include "number_between.h"
#include "other_programs.h"
#include "paper/paper_benchmark.h"
#include "psi/psi_benchmark.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "robustness/robustness_benchmark.h"
#include "run_program.h"
#include "simulate/simulate_benchmark.h"
#include "simulate/simulated_log_file.h"
#include "sparse/sparse_benchmark.h"
#include "verdict/verdict_benchmark.h"

namespace psi_slam {
namespace {

/// Options of one benchmark, and the options that all benchmarks share.
template <class Options>
struct Arguments : BenchArguments {
  Options options{};
};

/// Adds the output options to `command`, and the callback that runs the benchmark when `command` is parsed.
/// `logs_for(arguments)` chooses the logs, and `report_on(logs, options, progress)` makes the report.
template <class Options, class LogsFor, class ReportOn>
void run_on_logs(CLI::App& command, const std::shared_ptr<Arguments<Options>>& arguments,
                 const Streams& streams, const LogsFor& logs_for, const ReportOn& report_on) {
  const std::string page = command.get_name() + ".md";
  add_output_options(command, *arguments, page + " and the plots");
  command.callback([=, &streams] {
    const auto logs = logs_for(*arguments);
    check_outputs(*arguments, page);
    const BenchReport report = with_progress(
        streams, [&](const auto& progress) { return report_on(logs, arguments->options, progress); });
    write_report(report, *arguments, streams);
  });
}

void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& purpose) {
  command.add_option("--seed", seed, purpose)->check(CLI::NonNegativeNumber)->capture_default_str();
}

/// Help for an option that chooses among the matchers of these names.
std::string matchers_text(const std::vector<std::string>& names) {
  return "Matchers to run, separated by commas: " + name_list(names) + ". Default: all";
}

void add_match_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<MatchBenchmarkOptions>>();
  MatchBenchmarkOptions& options = arguments->options;
  CLI::App& match = *app.add_subcommand("match", "Compare the matchers on loops drawn from real logs");
  add_data_options(match, *arguments);
  match.add_option("--cases", options.cases, "Number of positive cases from each log, and of negative ones")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_seed_option(match, options.seed, "Seed of the cases and of the random matchers");
  match
      .add_option(
          "--parts", options.parts,
          "Parts to run, of scans, contexts and windows, separated by commas. The last compares over sizes "
          "of the window, with a fifth of the cases")
      ->delimiter(',')
      ->check(CLI::IsMember({kScansPart, kContextsPart, kWindowsPart}))
      ->capture_default_str()
      ->type_name("NAMES");
  run_on_logs(
      match, arguments, streams, [](const BenchArguments& given) { return logs_of(given); },
      [](const auto& logs, const auto& how, const ProgressObserver& progress) {
        return match_report(run_match_benchmark(logs, how, progress), how, machine_text());
      });
}

void add_false_loops_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<FalseLoopBenchmarkOptions>>();
  CLI::App& command = *app.add_subcommand(
      "false-loops",
      "Add false loops and slips to the graphs of real logs and measure the errors of the maps");
  add_data_options(command, *arguments);
  add_logs_option(command, *arguments);
  command
      .add_option(
          "--shares", arguments->options.shares_percent,
          "Numbers of false loops in percent of the true loops, separated by commas. For slips: percent "
          "of the stretches that are bent; values above 100 are left out")
      ->delimiter(',')
      ->check(number_between(0.0, 10'000.0))
      ->capture_default_str()
      ->type_name("PERCENTS");
  add_seeds_option(command, arguments->options.seeds, "Seeds of the false loops and slips");
  run_on_logs(
      command, arguments, streams, [&](const auto& data) { return chosen_logs(data, streams); },
      [](const ChosenLogs& chosen, const auto& options, const ProgressObserver& progress) {
        FalseLoopBenchmark benchmark = run_false_loop_benchmark(chosen.logs, options, progress);
        benchmark.without_relations = chosen.without_relations;
        return false_loop_report(benchmark, options, machine_text());
      });
}

void add_robustness_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<SeedRange>>();
  CLI::App& command =
      *app.add_subcommand("robustness", "Degrade real logs and measure the errors of their maps");
  add_data_options(command, *arguments);
  add_logs_option(command, *arguments);
  add_seeds_option(command, arguments->options, "Seeds of the odometry noise");
  run_on_logs(
      command, arguments, streams, [&](const auto& data) { return chosen_logs(data, streams); },
      [](const ChosenLogs& chosen, const SeedRange& seeds, const ProgressObserver& progress) {
        RobustnessBenchmark benchmark = run_robustness_benchmark(chosen.logs, seeds, progress);
        benchmark.without_relations = chosen.without_relations;
        return robustness_report(benchmark, seeds, machine_text());
      });
}

/// The logs of `verdict`; none without --data.
std::vector<BenchmarkLog> verdict_logs(const BenchArguments& arguments) {
  if (arguments.data.empty() && !arguments.names.empty())
    throw UserError("--logs needs the folder of the logs: --data DIR");
  if (arguments.data.empty()) return {};
  SparseLogs found = find_sparse_logs(arguments.data, ini_folder_of(arguments), arguments.names);
  std::move(found.sparse.begin(), found.sparse.end(), std::back_inserter(found.dense));
  return found.dense;
}

void add_verdict_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<VerdictBenchmarkOptions>>();
  VerdictBenchmarkOptions& options = arguments->options;
  CLI::App& command =
      *app.add_subcommand("verdict", "Judge maps with known faults and compare with their errors");
  add_data_options(command, *arguments);
  command.get_option("--data")->required(false)->description(
      "Folder of logs NAME.clf.gz with NAME.relations, and of the folder sparse with more logs; default: "
      "only "
      "simulated buildings");
  add_logs_option(command, *arguments);
  add_seeds_option(command, options.seeds, "Seeds of the buildings, runs and faults");
  add_seeds_option(command, options.log_seeds, "Seeds of the faults of each log", "--log-seeds");
  command
      .add_option("--path-m", options.path_m,
                  "Length of the shortest paths in metres; the longest are 1.75 times as long")
      ->check(number_between(20.0, 10'000.0))
      ->capture_default_str();
  run_on_logs(command, arguments, streams, verdict_logs,
              [](const std::vector<BenchmarkLog>& logs, const auto& how, const ProgressObserver& progress) {
                return verdict_report(run_verdict_benchmark(logs, how, progress), how, machine_text());
              });
}

struct SimulateArguments : Arguments<SimulateOptions> {
  std::string log;
};

/// Floor plan and path of the shortest run, as SVG. Pictures of longer runs are too large to read.
std::string plan_of_shortest(const SimulateOptions& options) {
  const double path_m = *std::min_element(options.path_m.begin(), options.path_m.end());
  SimulatedLog log(simulated_run_options(options, path_m));
  Trajectory truth;
  while (const std::optional<Frame> frame = log.next())
    truth.push_back({frame->time_us, log.world_T_robot()});
  return plan_svg(log.plan(), truth);
}

void run_simulate(const SimulateArguments& arguments, const Streams& streams) {
  const SimulateOptions& options = arguments.options;
  check_outputs(arguments, "simulate.md");
  if (!arguments.log.empty() && options.path_m.size() != 1)
    throw UserError("--write-log writes one run: name one length with --path-m");
  if (!arguments.log.empty()) check_simulated_log_file(arguments.log);
  const std::vector<SimulateRow> rows =
      with_progress(streams, [&](const auto& progress) { return run_simulate_benchmark(options, progress); });

  // Make the report only now: forked children of the benchmark would count this memory as their own.
  BenchReport report = simulate_report(rows, options, machine_text());
  if (!arguments.output.empty()) report.plots.push_back({"simulate-plan.svg", plan_of_shortest(options)});
  if (!arguments.log.empty())
    write_simulated_log(arguments.log, simulated_run_options(options, options.path_m.front()));
  write_report(report, arguments, streams);
}

void add_simulate_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<SimulateArguments>();
  SimulateOptions& options = arguments->options;
  CLI::App& simulate = *app.add_subcommand(
      "simulate", "Map simulated runs of growing length and compare the maps with the truth");
  simulate.add_option("--path-m", options.path_m, "Lengths of the paths in metres, separated by commas")
      ->delimiter(',')
      ->check(number_between(20.0, 100'000.0))
      ->capture_default_str();
  simulate
      .add_option("--corridors-m", options.corridors_m,
                  "Length of the corridors in metres, to drive through one building again and again. "
                  "Default: a third of each path")
      ->check(number_between(20.0, 100'000.0));
  add_seed_option(simulate, options.seed, "Seed of the buildings, paths and noise");
  simulate
      .add_option("--people", options.people,
                  "Number of people who walk the corridors, for every 500 m of path")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  simulate
      .add_option("--glass", options.glass_share,
                  "Share of the front walls of rooms and of the outer walls that is glass")
      ->check(number_between(0.0, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  simulate.add_option("--max-range-m", options.max_range_m, "Largest range of the laser in metres")
      ->check(number_between(1.0, 1000.0))
      ->capture_default_str();
  simulate
      .add_option("--range-noise-m", options.range_noise_m,
                  "Standard deviation of the noise of a range in metres")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
  simulate
      .add_option("--threads", options.threads, "Number of threads that match loops; it changes times only")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  add_output_options(simulate, *arguments,
                     "simulate.md, the plots and a picture of the shortest run's floor plan");
  simulate
      .add_option(
          "--write-log", arguments->log,
          "Also write the run as a log to FILE, NAME.clf.gz, and the truth to NAME.relations and NAME.tum")
      ->type_name("FILE");
  simulate.callback([arguments, &streams] { run_simulate(*arguments, streams); });
}

/// Finds the logs of the benchmark, checks their settings and prints warnings about them. Returns no logs if
/// no part of the benchmark needs any. Throws UserError for invalid settings or without --data.
SparseLogs sparse_logs(const Arguments<SparseOptions>& arguments, const Streams& streams) {
  const SparseOptions& options = arguments.options;
  benchmark_settings({}, options.assignments);
  if (!options.needs_logs()) return {};
  if (arguments.data.empty()) throw UserError("name the folder of the logs with --data DIR");
  SparseLogs logs = find_sparse_logs(arguments.data, ini_folder_of(arguments), arguments.names);
  std::vector<std::string> warnings;
  for (const auto* some : {&logs.dense, &logs.sparse})
    for (const BenchmarkLog& log : *some) benchmark_settings(log.ini, options.assignments, &warnings);
  for (const std::string& warning : warnings) streams.err << "psi-slam-bench: " << warning << '\n';
  return logs;
}

void add_sparse_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<SparseOptions>>();
  SparseOptions& options = arguments->options;
  options.sensors.threads = worker_threads({});
  CLI::App& command = *app.add_subcommand(
      "sparse", "Map logs and simulated runs with few scans or few beams and measure errors and costs");
  add_data_options(command, *arguments);
  command.get_option("--data")->required(false)->description(
      "Folder of the logs NAME.clf.gz with NAME.relations, and of the folder sparse with more logs");
  add_logs_option(command, *arguments);
  command
      .add_option("--parts", options.parts,
                  "Parts to run, of thinned, every-nth, sparse and simulated; default: all. All parts but "
                  "simulated need --data")
      ->delimiter(',')
      ->check(CLI::IsMember(SparseOptions().parts))
      ->type_name("NAMES");
  add_seeds_option(command, options.seeds, "Seeds of the runs");
  command
      .add_option("--set", options.assignments,
                  "Change one option for all logs and simulated runs. May be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  run_on_logs(
      command, arguments, streams, [&](const auto& data) { return sparse_logs(data, streams); },
      [](const SparseLogs& logs, const auto& how, const ProgressObserver& progress) {
        return sparse_report(run_sparse_benchmark(logs, how, progress), how, machine_text());
      });
}

void add_paper_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<PaperOptions>>();
  PaperOptions& options = arguments->options;
  CLI::App& command = *app.add_subcommand(
      "paper", "Repeat the experiment of the paper: fixed windows, and a deadline of one scan period");
  add_data_options(command, *arguments);
  add_logs_option(command, *arguments);
  std::vector<std::string> names;
  for (const PaperCandidate& candidate : paper_candidates()) names.push_back(candidate.name);
  command.add_option("--matchers", options.matchers, matchers_text(names))
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->type_name("NAMES");
  add_seed_option(command, options.seed, "Seed of the genetic searches");
  run_on_logs(
      command, arguments, streams,
      [](const BenchArguments& given) {
        return find_sparse_logs(given.data, ini_folder_of(given), given.names);
      },
      [](const SparseLogs& logs, const PaperOptions& how, const ProgressObserver& progress) {
        return paper_report(run_paper_benchmark(logs, how, progress), how, machine_text());
      });
}

void add_psi_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<PsiBenchmarkOptions>>();
  PsiBenchmarkOptions& options = arguments->options;
  CLI::App& command =
      *app.add_subcommand("psi", "Compare the matchers in whole runs, divided by the factor Psi");
  add_data_options(command, *arguments);
  add_logs_option(command, *arguments);
  const std::vector<std::string> names = options.matchers;
  command.add_option("--matchers", options.matchers, matchers_text(names))
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->type_name("NAMES");
  add_seed_option(command, options.seed, "Seed of the genetic searches");
  run_on_logs(
      command, arguments, streams, [&](const auto& data) { return chosen_logs(data, streams); },
      [](const ChosenLogs& chosen, const PsiBenchmarkOptions& how, const ProgressObserver& progress) {
        PsiBenchmark benchmark = run_psi_benchmark(chosen.logs, how, progress);
        benchmark.without_relations = chosen.without_relations;
        return psi_report(benchmark, how, machine_text());
      });
}

void add_live_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<Arguments<LiveBenchmarkOptions>>();
  LiveBenchmarkOptions& options = arguments->options;
  CLI::App& command = *app.add_subcommand(
      "live", "Replay logs as a robot would deliver them and measure the time to each pose");
  add_data_options(command, *arguments);
  command.get_option("--data")->required(false)->description(
      "Folder of the logs NAME.clf.gz with NAME.relations, and of the folder sparse with more logs");
  add_logs_option(command, *arguments);
  command
      .add_option(
          "--speeds", options.speeds,
          "Replay speeds as multiples of the recorded speed, separated by commas; 0 replays as fast as "
          "possible")
      ->delimiter(',')
      ->check(number_between(0.0, 1000.0))
      ->capture_default_str();
  command
      .add_option("--processors", options.processors,
                  "Numbers of processors that a replay may use, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      .add_option("--timed-s", options.timed_s,
                  "Pace and time only the last seconds of each log; what comes before is mapped as fast as "
                  "possible; 0: all")
      ->check(number_between(0, 1e9))
      ->capture_default_str();
  command
      .add_option("--stretch-s", options.stretch_s,
                  "Replay only the first seconds of each log, without errors over relations; 0: all")
      ->check(number_between(0, 1e9))
      ->capture_default_str();
  command
      .add_option("--simulated-m", options.simulated_m,
                  "Also replay simulated runs of these path lengths in metres, separated by commas")
      ->delimiter(',')
      ->check(number_between(20.0, 100'000.0));
  command.add_option("--set", options.assignments, "Change one option for all replays. May be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  run_on_logs(
      command, arguments, streams,
      [](const Arguments<LiveBenchmarkOptions>& given) {
        benchmark_settings({}, given.options.assignments);
        if (!given.data.empty()) return find_sparse_logs(given.data, ini_folder_of(given), given.names);
        if (given.options.simulated_m.empty())
          throw UserError(
              "name the folder of the logs with --data DIR, or simulated runs with --simulated-m");
        return SparseLogs();
      },
      [](const SparseLogs& logs, const LiveBenchmarkOptions& how, const ProgressObserver& progress) {
        return live_report(run_live_benchmark(logs, how, progress), how, machine_text());
      });
}

}  // namespace

int run_bench_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept {
  CLI::App app("Measures accuracy and speed of psi-slam and of its parts.", "psi-slam-bench");
  return run_program(app, streams.out, streams.err, [&] {
    add_freiburg_command(app, streams);
    add_freiburg_run_command(app, streams);
    add_match_command(app, streams);
    add_simulate_command(app, streams);
    add_false_loops_command(app, streams);
    add_robustness_command(app, streams);
    add_verdict_command(app, streams);
    add_sparse_command(app, streams);
    add_paper_command(app, streams);
    add_psi_command(app, streams);
    add_live_command(app, streams);
    app.require_subcommand(1);
    app.set_version_flag("--version", "psi-slam-bench " PSI_SLAM_VERSION, "Print the version and exit");
    add_document_options(app,
                         {{"The benchmark is complete.", "Something failed, such as a run or a full disk.",
                           "The arguments, the settings or a log are invalid or missing."}});
    // CLI11 expects the last argument first.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    return kExitDone;
  });
}

}  // namespace psi_slam
