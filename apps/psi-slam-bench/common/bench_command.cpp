// SPDX-License-Identifier: BSD-3-Clause
#include "common/bench_command.h"

#include <unistd.h>

#include <algorithm>
#include <ostream>

#include "common/benchmark_logs.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

void add_data_options(CLI::App& command, DataArguments& arguments) {
  command.add_option("--data", arguments.data, "Folder of the logs: NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  command.add_option("--ini", arguments.ini, "Folder of their settings NAME.ini; default: those of psi-slam")
      ->type_name("DIR");
}

std::vector<BenchmarkLog> logs_of(const DataArguments& arguments) {
  return find_benchmark_logs(arguments.data, ini_folder(arguments.ini));
}

void add_output_options(CLI::App& command, OutputArguments& arguments, const std::string& content) {
  command
      .add_option("--json", arguments.json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  command
      .add_option("-o,--output", arguments.output,
                  "Folder for " + content + "; those that are there are replaced")
      ->type_name("DIR");
}

void check_outputs(const OutputArguments& arguments, const std::string& page) {
  if (!arguments.json.empty()) check_writable(arguments.json);
  if (!arguments.output.empty()) prepare_folder(arguments.output, page);
}

void add_logs_option(CLI::App& command, std::vector<std::string>& names) {
  command
      .add_option("--logs", names, "Only these, by name, commas in between; default: all that have relations")
      ->delimiter(',')
      ->type_name("NAMES");
}

void add_seeds_option(CLI::App& command, SeedRange& seeds, const std::string& purpose) {
  command
      .add_option_function<std::string>(
          "--seeds", [&seeds](const std::string& text) { seeds = parse_seeds(text); },
          purpose + ": N for 1 to N, or FIRST-LAST")
      ->default_str(std::to_string(seeds.last))
      ->type_name("SEEDS");
}

void check_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file)) throw UserError(file.string() + " is a folder: name a file");
  if (!fs::is_directory(folder)) throw UserError("the folder of " + file.string() + " does not exist");
  if (::access(folder.c_str(), W_OK) != 0) throw UserError(file.string() + " cannot be written");
}

void prepare_folder(const fs::path& folder, const std::string& file) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    throw UserError("the folder " + folder.string() + " cannot be made: " + failed.message());
  check_writable(folder / file);
}

fs::path ini_folder(const std::string& given) {
  if (!given.empty()) return given;
  if (const auto shipped = shipped_ini_folder()) return *shipped;
  throw UserError("name the folder of the logs' settings: --ini DIR");
}

ChosenLogs chosen_logs(const DataArguments& arguments, const std::vector<std::string>& names) {
  const std::vector<BenchmarkLog> all = logs_of(arguments);
  for (const std::string& name : names)
    if (std::none_of(all.begin(), all.end(), [&](const BenchmarkLog& log) { return log.name == name; }))
      throw UserError("--logs: there is no log called " + name + " in " + arguments.data);
  ChosenLogs chosen;
  for (const BenchmarkLog& log : all) {
    const bool named = std::find(names.begin(), names.end(), log.name) != names.end();
    if (named && !log.relations)
      throw UserError(log.log.string() + " has no relations to measure its error by: expected " + log.name +
                      ".relations beside it");
    if (!named && !names.empty())
      chosen.left_out.push_back(log.name);
    else if (!log.relations)
      chosen.without_relations.push_back(log.name);
    else
      chosen.logs.push_back(log);
  }
  if (chosen.logs.empty())
    throw UserError("no log can be evaluated: expected NAME.relations in " + arguments.data +
                    " beside its log");
  return chosen;
}

void print_page(const std::string& page, const Streams& streams) {
  streams.out << page << std::flush;
  if (!streams.out) throw SystemFailure("cannot write to standard output");
}

}  // namespace psi_slam
