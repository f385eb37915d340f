// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "psi_slam/base/user_error.h"
#include "psi_slam/config/nearest_name.h"

namespace psi_slam {
namespace {

constexpr const char* kSeeHelp = " (see psi-slam --help)";

void add_settings(CLI::App& app, CommandLine& line) {
  app.add_option("-c,--config", line.config, "Settings file; without it, the built-in defaults")
      ->type_name("INI");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&line](const std::vector<std::string>& given) {
           line.settings.insert(line.settings.end(), given.begin(), given.end());
         },
         "Change one option; may be given again")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

/// The one log among the arguments that are no options.
std::string only_log(const std::vector<std::string>& logs, const std::string& usage) {
  if (logs.empty()) throw UserError("name the log: " + usage + kSeeHelp);
  if (logs.size() == 1) return logs.front();
  const auto command = nearest_name(logs.front(), {"check", "options"});
  if (command)
    throw UserError("there is no command \"" + logs.front() + "\"; did you mean \"" + *command + "\"?");
  throw UserError("one log at a time: \"" + logs[0] + "\" and \"" + logs[1] + "\" were given" + kSeeHelp);
}

void check_together(const CommandLine& line) {
  const bool maps = line.command == CommandLine::Command::kMap;
  if (maps && line.output.empty()) throw UserError("name the folder for the results: -o DIR");
  if (!maps && !line.output.empty()) throw UserError("-o goes with mapping only: nothing is written here");
}

}  // namespace

CommandLine parse_command_line(const std::vector<std::string>& arguments, CLI::App& app) {
  CommandLine line;
  std::vector<std::string> logs;
  bool dump_config = false;
  app.add_option("LOG", logs, "Log to map: an MRPT rawlog or a CARMEN log, plain or gzipped")
      ->type_name("")
      ->expected(0, -1);
  app.add_option("-o,--output", line.output, "Folder for the results, new or empty")->type_name("DIR");
  add_settings(app, line);
  app.add_option("--seed", line.seed, "The same as --set run.seed=N")->type_name("N");
  app.add_option("--threads", line.threads, "The same as --set run.threads=N")->type_name("N");
  app.add_flag("--force", line.force, "Replace the results in a folder that is not empty");
  app.add_flag("--json", line.json, "Print the summary as JSON");
  CLI::Option* const quiet = app.add_flag("-q,--quiet", line.quiet, "Print nothing but complaints");
  app.add_flag("-v,--verbose", line.verbose, "Also print the settings changed and the times of all stages")
      ->excludes(quiet);
  app.add_flag("--dump-config", dump_config, "Print a settings file with all options, and exit");
  app.set_version_flag("--version", "psi-slam " PSI_SLAM_VERSION, "Print the version, and exit");

  CLI::App* const check =
      app.add_subcommand("check", "Tell what a log holds and what looks wrong, with the remedy");
  std::vector<std::string> checked_logs;
  check->add_option("LOG", checked_logs, "Log to look over")->type_name("")->expected(0, -1);
  add_settings(*check, line);
  check->add_flag("--json", line.json, "Print the findings as JSON");

  CLI::App* const options = app.add_subcommand("options", "Explain every option of the settings files");
  options->add_flag("--markdown", line.markdown, "Print a page in Markdown");
  app.require_subcommand(0, 1);

  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first

  if (options->parsed()) {
    line.command = CommandLine::Command::kOptions;
  } else if (check->parsed()) {
    line.command = CommandLine::Command::kCheck;
    line.log = only_log(checked_logs, "psi-slam check LOG");
  } else if (dump_config) {
    line.command = CommandLine::Command::kDumpConfig;
  } else {
    line.log = only_log(logs, "psi-slam LOG -o DIR");
  }
  const bool maps = line.command == CommandLine::Command::kMap;
  if (!maps && !logs.empty()) throw UserError("\"" + logs.front() + "\" is one argument too many" + kSeeHelp);
  check_together(line);
  return line;
}

}  // namespace psi_slam
