// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "document_options.h"
#include "psi_slam/user_error.h"
#include "config/nearest_name.h"

namespace psi_slam {
namespace {

constexpr const char* kSeeHelp = " (see psi-slam --help)";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  psi-slam check my.log                    what is in a log, and what is wrong with it\n"
    "  psi-slam my.log -o out/                  map it: open out/report.html\n"
    "  psi-slam my.log -o out/ --save-session my.session\n"
    "  psi-slam --resume my.session my.log -o more/   go on where that was interrupted\n"
    "  psi-slam merge monday.log friday.log -o out/   one map of several drives\n"
    "  psi-slam localize out/map.yaml new.log   where a robot is in a finished map\n"
    "  psi-slam -c my.ini my.log -o out/ --set map.resolution_m=0.025\n"
    "  psi-slam --dump-config > my.ini          settings to begin with\n"
    "  psi-slam sweep *.log -o out/ --set loop_closure.matcher=csm,ga --seeds 10\n";

bool is_option(const std::string& argument) {
  return argument.size() > 1 && argument.front() == '-';
}

/// What commands share that read logs and write a folder.
void add_run_options(CLI::App& command, CommandLine& line) {
  add_settings_options(command, line.config, line.settings);
  command.add_flag("--force", line.force, "Replace the results in a folder that is not empty");
  command.add_flag("--json", line.json, "Print the summary as JSON");
  command.add_flag("-q,--quiet", line.quiet, "Print nothing but complaints");
}

/// Complains about the first argument that is neither the log nor a known option.
[[noreturn]] void fail_unknown(const std::string& argument, const CommandLine& line, const CLI::App& app) {
  const auto command = nearest_name(line.log, {"check", "localize", "merge", "options", "sweep"});
  if (command && !is_option(argument))
    throw UserError("there is no command \"" + line.log + "\"; did you mean \"" + *command + "\"?");
  throw UserError(unknown_argument_text(argument, app, "psi-slam"));
}

void check_together(const CommandLine& line, const std::string& log_to_map) {
  using Command = CommandLine::Command;
  if (line.command == Command::kMap && line.log.empty() && line.resume.empty())
    throw UserError("name the log: psi-slam LOG -o DIR" + std::string(kSeeHelp));
  if (line.command == Command::kCheck && line.log.empty())
    throw UserError("name the log: psi-slam check LOG" + std::string(kSeeHelp));
  if (line.command == Command::kMap && line.output.empty())
    throw UserError("name the folder for the results: -o DIR" + std::string(kSeeHelp));
  if (line.command == Command::kLocalize && line.log.empty())
    throw UserError("name a map and a log: psi-slam localize MAP LOG" + std::string(kSeeHelp));
  const bool merges = line.command == Command::kMerge;
  if (merges && line.inputs.size() < 2)
    throw UserError("name the drives: psi-slam merge FIRST SECOND -o DIR" + std::string(kSeeHelp));
  if (merges && line.inputs.size() > 2 && !line.start.empty())
    throw UserError("--start goes with two drives: merge further ones with the session of the first two");
  if (merges && line.output.empty())
    throw UserError("name the folder for the results: -o DIR" + std::string(kSeeHelp));
  if (line.command != Command::kMap && line.command != Command::kLocalize && !merges && !line.output.empty())
    throw UserError("-o goes with mapping only: nothing is written here");
  if (line.command != Command::kMap && !line.edits.empty()) throw UserError("--edits goes with mapping only");
  if (line.command != Command::kMap && !line.resume.empty())
    throw UserError("--resume goes with mapping only");
  if (line.command != Command::kMap && !merges && !line.save_session.empty())
    throw UserError("--save-session goes with mapping only");
  if (line.command != Command::kMap && !log_to_map.empty())
    throw UserError("\"" + log_to_map + "\" is one argument too many" + kSeeHelp);
}

}  // namespace

void load_settings(const CommandLine& line, BoundSettings& bound) {
  bound.load(line.config, line.settings);
  if (line.seed) bound.table.set("run.seed", *line.seed, "--seed");
  if (line.threads) bound.table.set("run.threads", *line.threads, "--threads");
  check(bound.settings);
}

std::shared_ptr<const OptionTable> default_settings() {
  const auto bound = std::make_shared<BoundSettings>();
  return {bound, &bound->table};
}

void add_settings_options(CLI::App& app, std::string& config, std::vector<std::string>& settings) {
  app.add_option("-c,--config", config, "Settings file; without it, the built-in defaults")->type_name("INI");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&settings](const std::vector<std::string>& given) {
           settings.insert(settings.end(), given.begin(), given.end());
         },
         "Change one option; may be given again")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

std::string unknown_argument_text(const std::string& argument, const CLI::App& app,
                                  const std::string& program) {
  const std::string see_help = " (see " + program + " --help)";
  if (!is_option(argument)) return "\"" + argument + "\" is one argument too many" + see_help;
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  const auto near = nearest_name(argument, options);
  return "there is no option \"" + argument + '"' + (near ? "; did you mean \"" + *near + "\"?" : see_help);
}

CommandLine parse_command_line(const std::vector<std::string>& arguments, CLI::App& app) {
  CommandLine line;
  std::string log_to_map;
  bool dump_config = false;
  app.add_option("LOG", log_to_map,
                 "Log to map: an MRPT rawlog or a CARMEN log, plain or gzipped, or a ROS bag")
      ->type_name("");
  app.add_option("-o,--output", line.output, "Folder for the results, new or empty")->type_name("DIR");
  add_settings_options(app, line.config, line.settings);
  app.add_option("--edits", line.edits,
                 "Loops deleted, forced or matched by hand: a file as psi-slam-gui saves it")
      ->type_name("FILE");
  app.add_option("--save-session", line.save_session,
                 "Record the run in this file, also when it is interrupted, for --resume")
      ->type_name("FILE");
  app.add_option("--resume", line.resume,
                 "Go on with a recorded run: in the rest of its LOG or in one that follows, or with none")
      ->type_name("FILE");
  app.add_option("--seed", line.seed, "The same as --set run.seed=N")->type_name("N");
  app.add_option("--threads", line.threads, "The same as --set run.threads=N")->type_name("N");
  app.add_flag("--force", line.force, "Replace the results in a folder that is not empty");
  app.add_flag("--json", line.json, "Print the summary as JSON");
  app.add_flag("-q,--quiet", line.quiet, "Print nothing but complaints");
  app.add_flag("-v,--verbose", line.verbose, "Also print the settings changed and the times of all stages");
  app.add_flag("--dump-config", dump_config, "Print a settings file with all options, and exit");
  app.set_version_flag("--version", "psi-slam " PSI_SLAM_VERSION, "Print the version, and exit");

  CLI::App* const check = app.add_subcommand(
      "check",
      "Tell what a log holds and what looks wrong, with the remedy (exit code 2 when the log breaks off)");
  std::string log_to_check;
  check->add_option("LOG", log_to_check, "Log to look over")->type_name("");
  add_settings_options(*check, line.config, line.settings);
  check->add_flag("--json", line.json, "Print the findings as JSON");

  CLI::App* const localize = app.add_subcommand("localize",
                                                "Keep track of a robot in a finished map, and find it with "
                                                "no start pose (exit code 1: not localized at its end)");
  std::string log_to_localize;
  localize->add_option("MAP", line.map, "A map as a run writes it: map.yaml or map.gridmap.gz")
      ->type_name("");
  localize->add_option("LOG", log_to_localize, "Log of a robot in that building")->type_name("");
  localize
      ->add_option("-o,--output", line.output, "Folder for localization.csv and trajectory.tum, new or empty")
      ->type_name("DIR");
  localize->add_option("--start", line.start, "About where it starts: metres and degrees in the map")
      ->type_name("X,Y,YAW_DEG");
  add_run_options(*localize, line);

  CLI::App* const merge = app.add_subcommand(
      "merge", "Map several drives through one building as one (exit code 2 where one cannot be placed)");
  merge->add_option("INPUT", line.inputs, "Logs, or sessions as --save-session records them")->type_name("");
  merge->add_option("-o,--output", line.output, "Folder for the results, new or empty")->type_name("DIR");
  merge
      ->add_option("--start", line.start,
                   "About where the second drive begins: metres and degrees in the map of the first")
      ->type_name("X,Y,YAW_DEG");
  merge
      ->add_option("--save-session", line.save_session, "Record the merged drives in this file, for --resume")
      ->type_name("FILE");
  add_run_options(*merge, line);

  CLI::App* const options = app.add_subcommand("options", "Explain every option of the settings files");
  options->add_flag("--markdown", line.markdown, "Print a page in Markdown");

  CLI::App* const sweep = app.add_subcommand("sweep", "Map many logs with many settings, and compare");
  add_sweep_options(*sweep, line.sweep);
  add_processes_option(*sweep, line.sweep);

  app.require_subcommand(0, 1);
  app.allow_extras();
  check->allow_extras();
  localize->allow_extras();
  merge->allow_extras();
  options->allow_extras();
  sweep->allow_extras();
  app.footer(kExamples);
  add_document_options(app, default_settings());
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first

  if (options->parsed()) {
    line.command = CommandLine::Command::kOptions;
  } else if (check->parsed()) {
    line.command = CommandLine::Command::kCheck;
    line.log = log_to_check;
  } else if (sweep->parsed()) {
    line.command = CommandLine::Command::kSweep;
  } else if (localize->parsed()) {
    line.command = CommandLine::Command::kLocalize;
    line.log = log_to_localize;
  } else if (merge->parsed()) {
    line.command = CommandLine::Command::kMerge;
  } else if (dump_config) {
    line.command = CommandLine::Command::kDumpConfig;
  } else {
    line.log = log_to_map;
  }
  const std::vector<CLI::App*> commands = app.get_subcommands();  // that were parsed
  const CLI::App& spoken_to = commands.empty() ? app : *commands.front();
  const std::vector<std::string> unknown = app.remaining(true);
  if (!unknown.empty()) fail_unknown(unknown.front(), line, spoken_to);
  if (line.quiet && line.verbose) throw UserError("--quiet and --verbose do not go together");
  check_together(line, log_to_map);
  return line;
}

}  // namespace psi_slam
