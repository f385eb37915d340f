// SPDX-License-Identifier: BSD-3-Clause
// The commands of psi-slam-bench, and the options and steps that they share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "batch/child_process.h"
#include "batch/seeds.h"
#include "common/bench_report.h"
#include "common/benchmark_logs.h"
#include "progress_line.h"
#include "psi_slam_app.h"

namespace psi_slam {

// Each function adds a command with its options to the program. Parsing the command line runs the command,
// which throws UserError for wrong input. `streams` must outlive `app`.
void add_freiburg_run_command(CLI::App& app, const Streams& streams);  ///< one run, for `freiburg` to start
void add_match_command(CLI::App& app, const Streams& streams);
void add_simulate_command(CLI::App& app, const Streams& streams);
void add_false_loops_command(CLI::App& app, const Streams& streams);
void add_robustness_command(CLI::App& app, const Streams& streams);

/// Workers of the `freiburg` command.
struct FreiburgWork {
  std::filesystem::path program = "/proc/self/exe";  ///< with the command of add_freiburg_run_command()
  ChildWorkers workers{};    ///< empty: processes of this machine, and options for these and for baselines
  int runs_at_a_time = 1;    ///< of `workers`
  bool only_parsed = false;  ///< parse the command line without running the command
};
void add_freiburg_command(CLI::App& app, const Streams& streams, const FreiburgWork& work = {});

/// Values of the options --data, --ini and --logs.
struct DataArguments {
  std::string data;
  std::string ini;
  std::vector<std::string> names;  ///< of logs; empty: all that have relations
};
void add_data_options(CLI::App& command, DataArguments& arguments);
void add_logs_option(CLI::App& command, DataArguments& arguments);

/// All logs of the folder; see find_benchmark_logs().
std::vector<BenchmarkLog> logs_of(const DataArguments& arguments);

/// The logs for a command to work on, and the names of the other logs in the folder.
struct ChosenLogs {
  std::vector<BenchmarkLog> logs;              ///< all with relations
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<std::string> left_out;           ///< logs that were not asked for
};

/// The logs that --logs names, or all logs with relations, in the order of the folder. Throws UserError as
/// logs_of(), for an unknown name, for a named log without relations, for settings that psi-slam refuses, and
/// when no log remains. Prints warnings about the settings of the logs.
ChosenLogs chosen_logs(const DataArguments& arguments, const Streams& streams);

/// Values of the options --json, --csv and -o; empty: not written.
struct OutputArguments {
  std::string json;
  std::string csv;
  std::string output;
};

/// `content` names the files for the folder -o: "match.md and the plots".
void add_output_options(CLI::App& command, OutputArguments& arguments, const std::string& content);

/// Creates the folder for `page` and throws UserError if a file cannot be written. Called before the work,
/// which takes long.
void check_outputs(const OutputArguments& arguments, const std::string& page);

/// Writes the files that the options ask for, then prints the page. Throws SystemFailure when it cannot.
void write_report(const BenchReport& report, const OutputArguments& arguments, const Streams& streams);

/// Adds --seeds; `purpose` says what the seeds are for.
void add_seeds_option(CLI::App& command, SeedRange& seeds, const std::string& purpose);

/// Adds --seed; `purpose` says what the seed is for.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& purpose);

/// Calls `work` with an observer that shows its progress on a terminal, and returns its result.
template <class Work>
auto with_progress(const Streams& streams, const Work& work) {
  WorkProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  return work([&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
}

/// Throws UserError when `file` cannot be written.
void check_writable(const std::filesystem::path& file);

/// Creates the folder if necessary and calls check_writable() for `file` in it.
void prepare_folder(const std::filesystem::path& folder, const std::string& file);

}  // namespace psi_slam
