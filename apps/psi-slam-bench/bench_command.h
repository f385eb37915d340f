// SPDX-License-Identifier: BSD-3-Clause
// The commands of psi-slam-bench, a file each, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmark_logs.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Each adds its command with its options to the program; parsing the command line then runs it. It throws
/// UserError when the user must mend something. `streams` outlives `app`.
void add_freiburg_command(CLI::App& app, const Streams& streams);
void add_match_command(CLI::App& app, const Streams& streams);
void add_simulate_command(CLI::App& app, const Streams& streams);
void add_false_loops_command(CLI::App& app, const Streams& streams);
void add_robustness_command(CLI::App& app, const Streams& streams);

/// Throws UserError when `file` cannot be written: told before the work, which is long.
void check_writable(const std::filesystem::path& file);

/// Makes the folder if it is not there, and checks that `file` can be written in it, as check_writable().
void prepare_folder(const std::filesystem::path& folder, const std::string& file);

/// The folder of the logs' settings: `given`, or the one that comes with the program if that is empty. Throws
/// UserError when there is none.
std::filesystem::path ini_folder(const std::string& given);

/// Those of the logs that have these names, in the logs' order; all of them when there are no names. Throws
/// UserError when a name is not among them, or a chosen log has no relations to measure its error by.
std::vector<BenchmarkLog> chosen_logs(std::vector<BenchmarkLog> logs, const std::vector<std::string>& names);

/// Writes the page to standard output. Throws SystemFailure when it cannot.
void print_page(const std::string& page, const Streams& streams);

}  // namespace psi_slam
