// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "batch/kept_run.h"
#include "common/bench_command.h"
#include "psi_slam/user_error.h"
#include "simulate/simulate_benchmark.h"
#include "simulate/simulated_log_file.h"

namespace psi_slam {
namespace {

struct SimulateArguments {
  OutputArguments output;
  std::string log;
  SimulateOptions options;
};

/// Floor plan and path of the shortest run, as SVG: pictures of longer runs are too large to read.
std::string plan_of_shortest(const SimulateOptions& options) {
  const double path_m = *std::min_element(options.path_m.begin(), options.path_m.end());
  SimulatedLog log(simulated_run_options(options, path_m));
  Trajectory truth;
  while (const std::optional<Frame> frame = log.next())
    truth.push_back({frame->time_us, log.world_T_robot()});
  return plan_svg(log.plan(), truth);
}

void check(const SimulateArguments& arguments) {
  check_outputs(arguments.output, "simulate.md");
  if (arguments.log.empty()) return;
  if (arguments.options.path_m.size() != 1)
    throw UserError("--write-log writes one run: name one length with --path-m");
  check_simulated_log_file(arguments.log);
}

void run_simulate(const SimulateArguments& arguments, const Streams& streams) {
  check(arguments);
  const SimulateOptions& options = arguments.options;
  const std::vector<SimulateRow> rows =
      with_progress(streams, [&](const auto& progress) { return run_simulate_benchmark(options, progress); });

  // Not before the benchmark: memory of this process would count as memory of its children.
  BenchReport report = simulate_report(rows, options, machine_text());
  if (!arguments.output.output.empty())
    report.plots.push_back({"simulate-plan.svg", plan_of_shortest(options)});
  if (!arguments.log.empty())
    write_simulated_log(arguments.log, simulated_run_options(options, options.path_m.front()));
  write_report(report, arguments.output, streams);
}

}  // namespace

void add_simulate_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<SimulateArguments>();
  SimulateOptions& options = arguments->options;
  CLI::App* const simulate = app.add_subcommand(
      "simulate", "Map simulated runs of growing length and compare the maps with the truth");
  simulate->add_option("--path-m", options.path_m, "Lengths of the paths in metres, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(20.0, 100'000.0))
      ->capture_default_str();
  add_seed_option(*simulate, options.seed, "Seed of the buildings, paths and noise");
  simulate
      ->add_option("--people", options.people,
                   "Number of people who walk the corridors, for every 500 m of path")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  simulate
      ->add_option("--glass", options.glass_share,
                   "Share of the front walls of rooms and of the outer walls that is glass")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  simulate
      ->add_option("--threads", options.threads, "Number of threads that match loops; it changes times only")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  add_output_options(*simulate, arguments->output,
                     "simulate.md, the plots and a picture of the shortest run's floor plan");
  simulate
      ->add_option(
          "--write-log", arguments->log,
          "Also write the run as a log to FILE, NAME.clf.gz, and the truth to NAME.relations and NAME.tum")
      ->type_name("FILE");
  simulate->callback([arguments, &streams] { run_simulate(*arguments, streams); });
}

}  // namespace psi_slam
