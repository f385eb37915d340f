// SPDX-License-Identifier: BSD-3-Clause
#include "common/bench_command.h"

#include <unistd.h>

#include <algorithm>
#include <ostream>

#include "base/atomic_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

void add_data_options(CLI::App& command, BenchArguments& arguments) {
  command.add_option("--data", arguments.data, "Folder of the logs NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--ini", arguments.ini,
                  "Folder of the settings NAME.ini of the logs; default: the folder that comes with psi-slam")
      ->type_name("DIR");
}

void add_logs_option(CLI::App& command, BenchArguments& arguments) {
  command
      .add_option("--logs", arguments.names,
                  "Names of the logs to use, separated by commas; default: all logs with relations")
      ->delimiter(',')
      ->type_name("NAMES");
}

fs::path ini_folder_of(const BenchArguments& arguments) {
  if (!arguments.ini.empty()) return arguments.ini;
  if (const auto shipped = shipped_ini_folder()) return *shipped;
  throw UserError(
      "the settings of the logs were not found beside the program: name their folder with --ini DIR");
}

std::vector<BenchmarkLog> logs_of(const BenchArguments& arguments) {
  return find_benchmark_logs(arguments.data, ini_folder_of(arguments));
}

ChosenLogs chosen_logs(const BenchArguments& arguments, const Streams& streams) {
  const std::vector<BenchmarkLog> all = logs_of(arguments);
  const std::vector<std::string>& names = arguments.names;
  for (const std::string& name : names)
    if (std::none_of(all.begin(), all.end(), [&](const BenchmarkLog& log) { return log.name == name; }))
      throw UserError("--logs: there is no log called " + name + " in " + arguments.data);
  ChosenLogs chosen;
  for (const BenchmarkLog& log : all) {
    const bool named = std::find(names.begin(), names.end(), log.name) != names.end();
    if (named && !log.relations)
      throw UserError(log.log.string() + " has no relations to measure its error: expected " + log.name +
                      ".relations beside it");
    if (!named && !names.empty())
      chosen.left_out.push_back(log.name);
    else if (!log.relations)
      chosen.without_relations.push_back(log.name);
    else
      chosen.logs.push_back(log);
  }
  if (chosen.logs.empty())
    throw UserError("no log can be evaluated: expected NAME.relations beside a log in " + arguments.data);
  std::vector<std::string> warnings;
  for (const BenchmarkLog& log : chosen.logs) benchmark_settings(log.ini, {}, &warnings);
  for (const std::string& warning : warnings) streams.err << "psi-slam-bench: " << warning << '\n';
  return chosen;
}

void add_output_options(CLI::App& command, BenchArguments& arguments, const std::string& content) {
  command
      .add_option("--json", arguments.json, "Write all figures to FILE as JSON, replacing an existing FILE")
      ->type_name("FILE");
  command
      .add_option("--csv", arguments.csv, "Write the main table to FILE as CSV, replacing an existing FILE")
      ->type_name("FILE");
  CLI::Option* const folder = command.add_option("-o,--output", arguments.output, "Folder for " + content);
  folder->type_name("DIR");
  if (!arguments.output.empty()) folder->capture_default_str();
}

void check_outputs(const BenchArguments& arguments, const std::string& page) {
  for (const std::string& file : {arguments.json, arguments.csv})
    if (!file.empty()) check_writable(file);
  if (!arguments.output.empty()) prepare_folder(arguments.output, page);
}

void write_report(const BenchReport& report, const BenchArguments& arguments, const Streams& streams) {
  if (!arguments.json.empty()) write_text_atomically(arguments.json, report.json);
  if (!arguments.csv.empty()) write_text_atomically(arguments.csv, report.csv);
  if (const fs::path folder = arguments.output; !folder.empty()) {
    write_text_atomically(folder / report.page, report.markdown);
    for (const BenchReport::Plot& plot : report.plots)
      write_text_atomically(folder / plot.file, plot.content);
  }
  streams.out << report.markdown << std::flush;
  if (!streams.out) throw SystemFailure("cannot write to standard output");
}

void add_seeds_option(CLI::App& command, SeedRange& seeds, const std::string& purpose,
                      const std::string& name) {
  command
      .add_option_function<std::string>(
          name, [&seeds](const std::string& text) { seeds = parse_seeds(text); },
          purpose + ": N for the seeds 1 to N, or FIRST-LAST")
      ->default_str(std::to_string(seeds.last))
      ->type_name("SEEDS");
}

void check_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file)) throw UserError(file.string() + " is a folder, expected a file: name a file");
  if (!fs::is_directory(folder))
    throw UserError("the folder of " + file.string() + " does not exist: create it first");
  if (::access(folder.c_str(), W_OK) != 0)
    throw UserError(file.string() + " cannot be written: its folder is write-protected. Name another folder");
}

void prepare_folder(const fs::path& folder, const std::string& file) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    throw UserError("the folder " + folder.string() + " cannot be created: " + failed.message());
  check_writable(folder / file);
}

}  // namespace psi_slam
