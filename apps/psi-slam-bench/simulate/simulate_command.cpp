// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "common/bench_command.h"
#include "match/match_report.h"
#include "simulate/plan_picture.h"
#include "base/atomic_file.h"
#include "psi_slam/user_error.h"
#include "batch/machine_text.h"
#include "simulate/simulate_benchmark.h"
#include "simulate/simulate_report.h"
#include "simulate/simulated_log_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  OutputArguments output;
  std::string log;
  SimulateOptions options;
};

/// Of the shortest drive, which is a picture that one can see something in.
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
    throw UserError("--write-log takes one drive: name one length with --path-m");
  check_simulated_log_file(arguments.log);
}

void run_simulate(const SimulateArguments& arguments, const Streams& streams) {
  check(arguments);
  const SimulateOptions& options = arguments.options;
  const std::vector<SimulateRow> rows =
      with_progress(streams, [&](const auto& progress) { return run_simulate_benchmark(options, progress); });

  const std::string machine = machine_text();
  const std::string page = simulate_markdown(rows, options, machine);
  if (!arguments.output.json.empty())
    write_text_atomically(arguments.output.json, simulate_json(rows, options, machine));
  if (!arguments.output.output.empty()) {
    const fs::path folder = arguments.output.output;
    write_text_atomically(folder / "simulate.md", page);
    write_text_atomically(folder / "simulate-error.svg", error_plot(rows));
    write_text_atomically(folder / "simulate-time.svg", time_plot(rows));
    write_text_atomically(folder / "simulate-memory.svg", memory_plot(rows));
    write_text_atomically(folder / "simulate-plan.svg", plan_of_shortest(options));
  }
  // Only now: a child that is forked while this process holds a drive would count that memory as its own.
  if (!arguments.log.empty())
    write_simulated_log(arguments.log, simulated_run_options(options, options.path_m.front()));
  print_page(page, streams);
}

}  // namespace

void add_simulate_command(CLI::App& app, const Streams& streams) {
  const auto arguments = std::make_shared<SimulateArguments>();
  SimulateOptions& options = arguments->options;
  CLI::App* const simulate =
      app.add_subcommand("simulate", "Map simulated drives of growing length, and compare with the truth");
  simulate->add_option("--path-m", options.path_m, "Lengths of the drives, metres, with commas between them")
      ->delimiter(',')
      ->check(CLI::Range(20.0, 100'000.0))
      ->capture_default_str();
  simulate->add_option("--seed", options.seed, "Of buildings, drives and noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  simulate->add_option("--people", options.people, "Who walk the corridors, for every 500 m of path")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  simulate->add_option("--glass", options.glass_share, "Share of rooms' fronts and outer walls that is glass")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  simulate->add_option("--threads", options.threads, "That match loops; only times depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  add_output_options(*simulate, arguments->output,
                     "simulate.md, the plots and a picture of the shortest drive's floor plan");
  simulate
      ->add_option("--write-log", arguments->log,
                   "Also write the drive as FILE, NAME.clf.gz, with its truth in NAME.relations and NAME.tum")
      ->type_name("FILE");
  simulate->callback([arguments, &streams] { run_simulate(*arguments, streams); });
}

}  // namespace psi_slam
