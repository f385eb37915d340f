// SPDX-License-Identifier: BSD-3-Clause
// The commands of psi-slam-bench, and the options and steps that they share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "batch/seeds.h"
#include "common/bench_report.h"
#include "common/benchmark_logs.h"
#include "freiburg/freiburg_benchmark.h"
#include "progress_line.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Adds the hidden command `freiburg-run`, which makes one run of the Freiburg benchmark. The command
/// `freiburg` starts it in a child process. Parsing the command line runs the command, which throws UserError
/// for wrong input. `streams` must outlive `app`.
void add_freiburg_run_command(CLI::App& app, const Streams& streams);

/// Adds the command `freiburg`. Parsing runs it, as above.
void add_freiburg_command(CLI::App& app, const Streams& streams);

/// Values of the options that the commands share.
struct BenchArguments {
  std::string data;
  std::string ini;
  std::vector<std::string> names;  ///< names of logs; empty: all logs that have relations
  std::string json;                ///< JSON file to write; empty: none
  std::string csv;                 ///< CSV file to write; empty: none
  std::string output;              ///< folder to write page and plots to; empty: none
};

/// Adds --data and --ini.
void add_data_options(CLI::App& command, BenchArguments& arguments);
void add_logs_option(CLI::App& command, BenchArguments& arguments);

/// Adds --json, --csv and -o. `content` names the files for the folder -o: "match.md and the plots".
void add_output_options(CLI::App& command, BenchArguments& arguments, const std::string& content);

/// Adds an option for a range of seeds; `purpose` says what the seeds are for.
void add_seeds_option(CLI::App& command, SeedRange& seeds, const std::string& purpose,
                      const std::string& name = "--seeds");

/// Folder of the settings of the logs: --ini, or the folder that comes with psi-slam. Throws UserError if
/// --ini is not given and no such folder is found.
std::filesystem::path ini_folder_of(const BenchArguments& arguments);

/// All logs in the folder --data. Throws UserError as ini_folder_of() and find_benchmark_logs().
std::vector<BenchmarkLog> logs_of(const BenchArguments& arguments);

/// The logs for a command to work on, and the names of the other logs in the folder.
struct ChosenLogs {
  std::vector<BenchmarkLog> logs;              ///< logs to map; all have relations
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<std::string> left_out;           ///< logs that --logs does not name
};

/// The logs that --logs names, or all logs with relations, ordered by name. Throws UserError as logs_of(),
/// for an unknown name, for a named log without relations, for settings that psi-slam refuses, and when no
/// log remains. Prints warnings about the settings of the logs.
ChosenLogs chosen_logs(const BenchArguments& arguments, const Streams& streams);

/// Creates the output folder. Throws UserError if `page` in it or another output file cannot be written. Call
/// it before the benchmark, which takes long.
void check_outputs(const BenchArguments& arguments, const std::string& page);

/// Writes the files that the options ask for, then prints the page. Throws SystemFailure if a file or
/// standard output cannot be written.
void write_report(const BenchReport& report, const BenchArguments& arguments, const Streams& streams);

/// Calls `work` with an observer that shows its progress on a terminal, and returns its result.
template <class Work>
auto with_progress(const Streams& streams, const Work& work) {
  WorkProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  return work([&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
}

/// Throws UserError when `file` cannot be written.
void check_writable(const std::filesystem::path& file);

/// Creates the folder if necessary and calls check_writable() for `file` in it. Throws UserError if the
/// folder cannot be created.
void prepare_folder(const std::filesystem::path& folder, const std::string& file);

}  // namespace psi_slam
