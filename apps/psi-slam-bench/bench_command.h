// SPDX-License-Identifier: BSD-3-Clause
// The commands of psi-slam-bench, a file each, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmark_logs.h"
#include "batch/child_workers.h"
#include "batch/seed_range.h"
#include "psi_slam_app.h"
#include "progress_line.h"

namespace psi_slam {

/// Each adds its command with its options to the program; parsing the command line then runs it. It throws
/// UserError when the user must mend something. `streams` outlives `app`.
void add_freiburg_run_command(CLI::App& app, const Streams& streams);  ///< of which `freiburg` starts many
void add_match_command(CLI::App& app, const Streams& streams);
void add_simulate_command(CLI::App& app, const Streams& streams);
void add_false_loops_command(CLI::App& app, const Streams& streams);
void add_robustness_command(CLI::App& app, const Streams& streams);

/// Who makes the runs of `freiburg`.
struct FreiburgWork {
  std::filesystem::path program = "/proc/self/exe";  ///< that knows add_freiburg_run_command()
  /// None: processes of this machine, as many as an option says; then there are rivals to be run, too.
  ChildWorkers workers{};
  int runs_at_a_time = 1;    ///< of these workers
  bool only_parsed = false;  ///< the command does nothing
};
void add_freiburg_command(CLI::App& app, const Streams& streams, const FreiburgWork& work = {});

/// What the commands that work on real logs are given: the options --data and --ini.
struct DataArguments {
  std::string data;
  std::string ini;
};
void add_data_options(CLI::App& command, DataArguments& arguments);

/// As find_benchmark_logs().
std::vector<BenchmarkLog> logs_of(const DataArguments& arguments);

/// Where a command leaves its results: the options --json and -o; empty where it is not asked to.
struct OutputArguments {
  std::string json;
  std::string output;
};
/// `content` is what the folder is for: "match.md and the plots".
void add_output_options(CLI::App& command, OutputArguments& arguments, const std::string& content);

/// As check_writable() and prepare_folder(), for `page` in the folder.
void check_outputs(const OutputArguments& arguments, const std::string& page);

/// The option --logs, for chosen_logs().
void add_logs_option(CLI::App& command, std::vector<std::string>& names);

/// The option --seeds; `purpose` says what they are for.
void add_seeds_option(CLI::App& command, SeedRange& seeds, const std::string& purpose);

/// The result of `work`, which is given what it is to report its progress to.
template <class Work>
auto with_progress(const Streams& streams, const Work& work) {
  WorkProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  return work([&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
}

/// Throws UserError when `file` cannot be written: told before the work, which is long.
void check_writable(const std::filesystem::path& file);

/// Makes the folder if it is not there, and checks that `file` can be written in it, as check_writable().
void prepare_folder(const std::filesystem::path& folder, const std::string& file);

/// The folder of the logs' settings: `given`, or the one that comes with the program if that is empty. Throws
/// UserError when there is none.
std::filesystem::path ini_folder(const std::string& given);

/// The logs that a command works on, and the names of the others in the folder.
struct ChosenLogs {
  std::vector<BenchmarkLog> logs;              ///< each with its relations
  std::vector<std::string> without_relations;  ///< that cannot be evaluated
  std::vector<std::string> left_out;           ///< that were not asked for
};

/// The logs of the folder that have these names, in the folder's order; when there are no names, all that
/// have relations. Throws UserError as logs_of(), when a name is not there, when a log that was named has no
/// relations, and when no log remains.
ChosenLogs chosen_logs(const DataArguments& arguments, const std::vector<std::string>& names);

/// Writes the page to standard output. Throws SystemFailure when it cannot.
void print_page(const std::string& page, const Streams& streams);

}  // namespace psi_slam
