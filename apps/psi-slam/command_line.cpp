// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <locale>
#include <ostream>
#include <sstream>
#include <utility>

#include "base/config/nearest_name.h"
#include "base/degrees.h"
#include "document_options.h"
#include "number_between.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

constexpr const char* kFolderHelp = "Folder for the results, new or empty";
constexpr const char* kSiteHelp =
    "Folder of a site: a building that is mapped again and again. Begins the site if the folder is new or "
    "empty. Otherwise aligns the run with the newest map in it and brings that map up to date. The results "
    "go into a new folder inside. Instead of -o";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  psi-slam check my.log                    show what a log holds and what is wrong with it\n"
    "  psi-slam my.log -o out/                  map a log; then open out/report.html\n"
    "  psi-slam my.log -o out/ --save-session my.session\n"
    "  psi-slam --resume my.session my.log -o more/   resume an interrupted run\n"
    "  psi-slam merge monday.log friday.log -o out/   make one map of several runs\n"
    "  psi-slam --continue office/ today.log    update the map of a building, day after day\n"
    "  psi-slam localize out/map.yaml new.log   find and track a robot in a finished map\n"
    "  psi-slam diff may/ june/ -o changes/     show the walls that changed between two maps\n"
    "  psi-slam eval out/trajectory.tum my.relations   measure the errors of a path\n"
    "  psi-slam live --ros2 -o out/             map while a ROS 2 robot drives\n"
    "  psi-slam play my.log --ros2              play a log as a ROS 2 robot\n"
    "  psi-slam -c my.ini my.log -o out/ --set map.resolution_m=0.025\n"
    "  psi-slam --dump-config > my.ini          print settings to start from\n"
    "  psi-slam sweep *.log -o out/ --set loop_closure.matcher=csm,ga --seeds 10\n"
    "  psi-slam options range                   explain the options about a word\n"
    "  psi-slam gui my.log                      watch how the map is built\n";

/// Tells where options are explained; `words` are what starts the command, such as "psi-slam merge".
std::string see_help(const std::string& words) {
  return " (see " + words + " --help)";
}

std::string unexpected_argument_text(const std::string& argument, const std::string& words) {
  return "unexpected argument \"" + argument + '"' + see_help(words);
}

bool is_option(const std::string& argument) {
  return argument.size() > 1 && argument.front() == '-';
}

/// Adds the options of all commands that write a folder.
void add_output_options(CLI::App& command, CommandLine& line) {
  command.add_flag("--force", line.force, "Replace results in a folder that is not empty");
  command.add_flag("--json", line.json, "Print the summary as JSON");
  command.add_flag("-q,--quiet", line.quiet, "Print only warnings and errors");
}

/// Adds the options of all commands that read logs and write a folder.
void add_run_options(CLI::App& command, CommandLine& line) {
  add_settings_options(command, line.config, line.settings);
  add_output_options(command, line);
}

CLI::App* add_check(CLI::App& app, CommandLine& line) {
  CLI::App* const check = app.add_subcommand(
      "check",
      "Show what a log holds, what looks wrong and how to fix it (exit code 2 if the log is damaged)");
  add_value(*check, "LOG", line.log, "Log to check", "");
  add_settings_options(*check, line.config, line.settings);
  check->add_flag("--json", line.json, "Print the findings as JSON");
  return check;
}

CLI::App* add_diff(CLI::App& app, CommandLine& line) {
  CLI::App* const diff = app.add_subcommand(
      "diff", "Show the walls that changed between two maps of a building (exit code 1 if a wall changed)");
  add_value(*diff, "MAP", line.inputs,
            "The older and the newer map: map.yaml, map.gridmap.gz or the results folder of a run", "");
  add_value(*diff, "-o,--output", line.output, "Folder for diff.png, diff.csv and diff.json, new or empty",
            "DIR");
  diff->add_flag("--aligned", line.diff.aligned, "Both maps have one frame: compare them without alignment");
  add_value(*diff, "--start", line.start,
            "Rough pose of the second map in the first: metres and degrees. Default: equal frames, then "
            "the whole map",
            "X,Y,YAW_DEG");
  add_value(*diff, "--tolerance-m", line.diff.tolerance_m,
            "Walls within this distance are equal; the uncertainty of the alignment is added. Default: three "
            "cells",
            "M");
  add_value(*diff, "--min-length-m", line.diff.min_length_m, "Length of the shortest change. Default: 0.3",
            "M");
  add_output_options(*diff, line);
  return diff;
}

CLI::App* add_eval(CLI::App& app, CommandLine& line) {
  CLI::App* const eval = app.add_subcommand(
      "eval",
      "Compare a trajectory with known relative poses: the metric of the Freiburg SLAM benchmark "
      "(Kümmerle et al. 2009) and the variant of Cartographer's tool");
  add_value(*eval, "TRAJECTORY", line.eval.trajectory,
            "Trajectory: trajectory.csv of a run, TUM format, lines 'timestamp x y theta', or a corrected "
            "CARMEN log with FLASER lines",
            "");
  add_value(*eval, "RELATIONS", line.eval.relations,
            "Known relative poses: lines 'time1 time2 x y z roll pitch yaw'", "");
  add_value(*eval, "--max-gap", line.eval.max_gap_s,
            "Longest gap between two poses that is interpolated, in seconds", "S")
      ->check(number_between(0.0, 1e9))
      ->capture_default_str();
  add_value(*eval, "--per-relation", line.eval.per_relation,
            "Write the error of each relation to this file (CSV)", "FILE");
  eval->add_flag("--force", line.force, "Replace an existing file of --per-relation");
  eval->add_flag("--json", line.json, "Print the result as JSON");
  return eval;
}

CLI::App* add_live(CLI::App& app, CommandLine& line) {
  CLI::App* const live = app.add_subcommand("live",
                                            "Map while the robot drives: from ROS 2, a stream of CARMEN "
                                            "lines, a growing log or sensors, until Ctrl-C");
  add_live_options(*live, line.live);
  add_value(*live, "-o,--output", line.output, kFolderHelp, "DIR");
  add_value(*live, "--continue", line.site, kSiteHelp, "SITE");
  add_value(*live, "--save-session", line.save_session, "Save the run to this file, for --resume", "FILE");
  add_value(*live, "--resume", line.resume, "Continue a saved or crashed run with the scans of the source",
            "FILE");
  add_run_options(*live, line);
  return live;
}

CLI::App* add_localize(CLI::App& app, CommandLine& line) {
  CLI::App* const localize = app.add_subcommand(
      "localize",
      "Find and track a robot in a finished map, without start pose (exit code 1 if it is not localized at "
      "the end)");
  add_value(*localize, "MAP", line.map, "Map written by psi-slam: map.yaml or map.gridmap.gz", "");
  add_value(*localize, "LOG", line.log, "Log of a robot in that building. Not with a live source", "");
  add_value(*localize, "-o,--output", line.output,
            "Folder for localization.csv and trajectory.tum, new or empty", "DIR");
  add_value(*localize, "--start", line.start, "Rough start of the robot: metres and degrees in the map",
            "X,Y,YAW_DEG");
  add_live_options(*localize, line.live);
  add_run_options(*localize, line);
  return localize;
}

CLI::App* add_merge(CLI::App& app, CommandLine& line) {
  CLI::App* const merge = app.add_subcommand(
      "merge", "Make one map of several runs through a building (exit code 2 if a run cannot be placed)");
  add_value(*merge, "INPUT", line.inputs, "Logs, or sessions saved by --save-session", "");
  add_value(*merge, "-o,--output", line.output, kFolderHelp, "DIR");
  add_value(*merge, "--start", line.start,
            "Rough start of the second run: metres and degrees in the map of the first run", "X,Y,YAW_DEG");
  add_value(*merge, "--save-session", line.save_session, "Save the merged runs to this file, for --resume",
            "FILE");
  add_run_options(*merge, line);
  return merge;
}

CLI::App* add_play(CLI::App& app, CommandLine& line) {
  CLI::App* const play = app.add_subcommand(
      "play",
      "Play a log as a ROS 2 robot: scans, odometry, transforms and /clock, for psi-slam, nav2 or RViz");
  add_value(*play, "LOG", line.log, "Any log that psi-slam reads", "");
  add_ros2_options(*play, line.play.ros2, "Required: publish on the topics of ROS 2");
  add_value(*play, "--speed", line.play.speed,
            "Speed: 1 as recorded, 2 twice as fast, 0 without waiting, which may lose messages", "FACTOR")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str();
  add_settings_options(*play, line.config, line.settings);
  play->add_flag("-q,--quiet", line.quiet, "Print no progress");
  return play;
}

CLI::App* add_options(CLI::App& app, CommandLine& line) {
  CLI::App* const options = app.add_subcommand("options", "Explain the options of the settings files");
  add_value(*options, "WORD", line.options.word, "Only options with this word in their name or description",
            "");
  options->add_flag("--common", line.options.common, "Only the ten options that most users need");
  options->add_flag("--json", line.json, "Print JSON");
  options->add_flag("--markdown", line.options.markdown, "Print a Markdown page of all options");
  return options;
}

CLI::App* add_help(CLI::App& app, CommandLine& line) {
  CLI::App* const help = app.add_subcommand("help", "Explain a command: psi-slam help COMMAND");
  add_value(*help, "COMMAND", line.other_arguments, "Command to explain. Default: list all commands", "");
  return help;
}

/// The commands that start other programs.
std::vector<CLI::App*> add_other_programs(CLI::App& app) {
  std::vector<CLI::App*> commands;
  for (const OtherProgram& other : other_programs())
    commands.push_back(app.add_subcommand(other.command, other.description));
  return commands;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string unknown_command_text(const std::string& word, const std::vector<std::string>& names) {
  const auto near = nearest_name(word, names);
  return "there is no command \"" + word + '"' +
         (near ? "; did you mean \"" + *near + "\"?" : see_help("psi-slam"));
}

bool is_command(const std::string& word, const std::vector<std::string>& commands) {
  return std::find(commands.begin(), commands.end(), word) != commands.end();
}

/// Removes the word "map" at the front. Throws UserError if one of the commands follows it.
std::vector<std::string> without_map(std::vector<std::string> arguments,
                                     const std::vector<std::string>& commands) {
  arguments.erase(arguments.begin());
  if (!arguments.empty() && is_command(arguments[0], commands))
    throw UserError("expected a log after map, not the command \"" + arguments[0] + "\". Write psi-slam " +
                    arguments[0] + ", or ./" + arguments[0] + " for a log of this name");
  return arguments;
}

/// Replaces "help COMMAND", "-h COMMAND" and "--help COMMAND" by "COMMAND --help". Other programs get the
/// words after the command, too: "help bench match" becomes "bench match --help". Throws UserError if "help"
/// is followed by anything else.
std::vector<std::string> in_long_form(std::vector<std::string> arguments,
                                      const std::vector<std::string>& commands) {
  if (!arguments.empty() && arguments[0] == "map") return without_map(std::move(arguments), commands);
  const auto rest = std::find_if(arguments.begin(), arguments.end(), [](const std::string& word) {
    return word != "help" && word != "-h" && word != "--help";
  });
  if (rest == arguments.begin()) return arguments;
  const bool by_command = arguments[0] == "help";
  arguments.erase(arguments.begin(), rest);
  const bool names_command = !arguments.empty() && is_command(arguments[0], commands);
  if (by_command && !arguments.empty() && !names_command)
    throw UserError(unknown_command_text(arguments[0], commands));
  const bool passes_on = names_command && other_program(arguments[0]) != nullptr;
  if (by_command && arguments.size() > 1 && !passes_on)
    throw UserError(unexpected_argument_text(arguments[1], "psi-slam"));
  if (!passes_on) arguments.resize(names_command && arguments[0] != "map" ? 1 : 0);
  arguments.emplace_back("--help");
  return arguments;
}

/// What the man page and the completion of psi-slam need beside its options.
ProgramFacts program_facts() {
  ProgramFacts facts{
      {"Success. Ctrl-C ends map and live with this code, too, and the results show the scans read so far.",
       "Something failed, such as a full disk. Commands that give 1 another meaning say so in their "
       "description.",
       "The arguments, the settings or the log are invalid. A log that breaks off is mapped up to the break. "
       "Failures of diff also give 2."},
      default_settings(),
      "map"};
  for (const OtherProgram& other : other_programs()) facts.programs[other.command] = other.program;
  return facts;
}

CLI::App* add_sweep(CLI::App& app, CommandLine& line) {
  CLI::App* const sweep = app.add_subcommand(
      "sweep", "Map many logs with many settings and compare the results (exit code 1 if a run failed)");
  add_sweep_options(*sweep, line.sweep);
  return sweep;
}

/// Fills `line` and returns true if the arguments are those of another program.
bool starts_other_program(const std::vector<std::string>& arguments, CommandLine& line) {
  const OtherProgram* const other = arguments.empty() ? nullptr : other_program(arguments.front());
  if (other == nullptr) return false;
  line.other_program = *other;
  line.other_arguments.assign(arguments.begin() + 1, arguments.end());
  line.command = CommandLine::Command::kOtherProgram;
  return true;
}

/// Throws UserError for an argument that is neither the log nor an option of `parsed`, which is the program
/// `app` or one of its commands.
[[noreturn]] void fail_unknown(const std::string& argument, const CommandLine& line, const CLI::App& app,
                               const CLI::App& parsed) {
  const std::vector<std::string> names = command_names(app);
  if (nearest_name(line.log, names) && !is_option(argument))
    throw UserError(unknown_command_text(line.log, names));
  throw UserError(unknown_argument_text(argument, parsed, parsed_words(app)));
}

void refuse(bool given, const char* why) {
  if (given) throw UserError(why);
}

/// Throws UserError if arguments are missing or contradict each other; `words` start the command.
void check_together(const CommandLine& line, const std::string& log_to_map, const std::string& words) {
  using Command = CommandLine::Command;
  const auto require = [&](bool given, const char* expected) {
    if (!given) throw UserError(expected + see_help(words));
  };
  const bool maps = line.command == Command::kMap;
  const bool is_live = line.command == Command::kLive;
  const bool merges = line.command == Command::kMerge;
  const bool compares = line.command == Command::kDiff;
  const bool localizes = line.command == Command::kLocalize;
  if (maps) require(!line.log.empty() || !line.resume.empty(), "name the log: psi-slam LOG");
  if (line.command == Command::kPlay)
    require(!line.log.empty() && line.play.ros2.is_given,
            "name the log, and add --ros2: psi-slam play LOG --ros2");
  if (line.command == Command::kCheck) require(!line.log.empty(), "name the log: psi-slam check LOG");
  const bool has_source = live_input(line.live).has_value();
  if (is_live)
    require(has_source, "name a source: --ros2, --stdin, --tcp PORT, --follow LOG or --sensors INI");
  if (localizes)
    require(!line.map.empty() && (has_source || !line.log.empty()),
            "name a map and a log, or a live source: psi-slam localize MAP LOG");
  refuse(has_source && !line.log.empty(), "name a log or a live source, not both");
  refuse(
      line.json && pose_format(line.live),
      "--json contradicts --poses: only poses go to standard output. Read the figures in the results folder");
  if (line.command == Command::kEval)
    require(!line.eval.relations.empty(),
            "name a trajectory and relations: psi-slam eval TRAJECTORY RELATIONS");
  if (compares) require(line.inputs.size() == 2, "name two maps: psi-slam diff OLDER NEWER");
  refuse(line.options.markdown && (line.json || line.options.common || !line.options.word.empty()),
         "--markdown prints all options: leave out WORD, --common and --json");
  refuse(line.diff.aligned && !line.start.empty(), "--aligned contradicts --start: give only one of them");
  if (merges) require(line.inputs.size() >= 2, "name the runs: psi-slam merge FIRST SECOND -o DIR");
  refuse(!maps && !is_live && !line.site.empty(),
         "--continue is only for mapping one log and for live. Leave it out");
  refuse(!line.site.empty() && !line.output.empty(),
         "--continue contradicts -o: the results go into the folder of the site. Leave -o out");
  if (merges) require(!line.output.empty(), "name the folder for the results: -o DIR");
  if (is_live)
    require(!line.output.empty() || !line.site.empty(),
            "name the folder for the results, or a site to continue: -o DIR or --continue SITE");
  refuse(merges && line.inputs.size() > 2 && !line.start.empty(),
         "--start needs exactly two runs. Merge the first two, then merge their session with further runs");
  refuse(!maps && !merges && !localizes && !is_live && !compares && !line.output.empty(),
         "-o has no effect on this command, because nothing is written. Leave -o out");
  refuse(!maps && !line.edits.empty(), "--edits is only for mapping a log");
  refuse(!maps && !is_live && !line.resume.empty(), "--resume is only for mapping");
  refuse(!maps && !line.journal.empty(), "--journal is only for mapping a log");
  refuse(!maps && !merges && !is_live && !line.save_session.empty(),
         "--save-session is only for mapping and merging logs");
  if (!maps && !log_to_map.empty()) throw UserError(unexpected_argument_text(log_to_map, words));
}

}  // namespace

void load_settings(const CommandLine& line, BoundSettings& bound, const Streams& streams) {
  bound.load(line.config, line.settings);
  if (line.seed) bound.table.set("run.seed", *line.seed, "--seed");
  if (line.threads) bound.table.set("run.threads", *line.threads, "--threads");
  for (const std::string& warning : bound.table.take_warnings())
    streams.err << "psi-slam: " << warning << '\n';
  check(bound.settings);
}

mrpt::math::TPose2D parse_start(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  std::array<double, 3> numbers{};
  char comma = ',';
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!((i == 0 || words >> comma) && comma == ',' && words >> numbers[i]))
      throw UserError("--start " + text + ": expected X,Y,YAW_DEG, such as 12.5,-3,90");
  if (words >> comma) throw UserError("--start " + text + ": expected only three numbers, X,Y,YAW_DEG");
  return {numbers[0], numbers[1], mrpt::math::wrapToPi(numbers[2] * radians_from_degrees(1))};
}

std::shared_ptr<const OptionTable> default_settings() {
  const auto bound = std::make_shared<BoundSettings>();
  return {bound, &bound->table};
}

void add_settings_options(CLI::App& app, std::string& config, std::vector<std::string>& settings) {
  add_value(app, "-c,--config", config, "Settings file. Default: the built-in settings", "INI");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&settings](const std::vector<std::string>& given) {
           settings.insert(settings.end(), given.begin(), given.end());
         },
         "Change one option. May be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

std::string unknown_argument_text(const std::string& argument, const CLI::App& app,
                                  const std::string& program) {
  if (!is_option(argument)) return unexpected_argument_text(argument, program);
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  const auto near = nearest_name(argument, options);
  return "there is no option \"" + argument + '"' +
         (near ? "; did you mean \"" + *near + "\"?" : see_help(program));
}

CommandLine parse_command_line(const std::vector<std::string>& given, CLI::App& app) {
  using Command = CommandLine::Command;
  CommandLine line;
  std::string log_to_map;
  bool dump_config = false;
  add_value(app, "LOG", log_to_map,
            "Log to map: an MRPT rawlog or a CARMEN log, plain or compressed, or a ROS bag", "");
  add_value(
      app, "-o,--output", line.output,
      "Folder for the results, new or empty. Default: NAME-map in the current folder for a log NAME.log",
      "DIR");
  add_value(app, "--continue", line.site, kSiteHelp, "SITE");
  add_run_options(app, line);
  add_value(app, "--edits", line.edits, "File with edits of loops and of the drawn map, and with known poses",
            "FILE");
  add_value(app, "--save-session", line.save_session,
            "Save the run to this file, even if it is interrupted, for --resume", "FILE");
  add_value(app, "--journal", line.journal,
            "Record the run in this file while it is mapped, for --resume after a crash; deleted at the end",
            "FILE");
  add_value(
      app, "--resume", line.resume,
      "Resume a saved or crashed run: with the rest of its LOG, with a LOG that continues it, or without "
      "LOG",
      "FILE");
  add_value(app, "--seed", line.seed, "Short for --set run.seed=N", "N");
  add_value(app, "--threads", line.threads, "Short for --set run.threads=N", "N");
  app.add_flag("-v,--verbose", line.verbose, "Also print the changed settings and the times of all stages");
  app.add_flag("--dump-config", dump_config, "Print a settings file with all options and exit");
  app.set_version_flag("--version", "psi-slam " PSI_SLAM_VERSION, "Print the version and exit");
  // Commands that in_long_form() and starts_other_program() replace. They must be the first word.
  std::vector<CLI::App*> first_words{app.add_subcommand("map", "Map a log. The word map may be left out")};
  const std::vector<std::pair<CLI::App*, Command>> commands{
      {add_check(app, line), Command::kCheck},       {add_diff(app, line), Command::kDiff},
      {add_eval(app, line), Command::kEval},         {add_live(app, line), Command::kLive},
      {add_localize(app, line), Command::kLocalize}, {add_merge(app, line), Command::kMerge},
      {add_options(app, line), Command::kOptions},   {add_play(app, line), Command::kPlay},
      {add_sweep(app, line), Command::kSweep}};
  first_words.push_back(add_help(app, line));
  for (CLI::App* command : add_other_programs(app)) first_words.push_back(command);
  app.require_subcommand(0, 1);
  app.allow_extras();
  for (const auto& [command, kind] : commands) command->allow_extras();
  for (CLI::App* word : first_words) word->allow_extras()->set_help_flag();
  app.footer(kExamples);
  add_document_options(app, program_facts());
  const std::vector<std::string> arguments = in_long_form(given, command_names(app));
  if (starts_other_program(arguments, line)) return line;
  // CLI11 expects the last argument first.
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));

  for (const CLI::App* word : first_words)
    if (word->parsed())
      throw UserError("write the command before its options: psi-slam " + word->get_name() + " ...");
  const CLI::App* parsed = &app;
  if (dump_config) line.command = Command::kDumpConfig;
  for (const auto& [command, kind] : commands)
    if (command->parsed()) parsed = command, line.command = kind;
  if (line.command == Command::kMap) line.log = log_to_map;
  const std::vector<std::string> unknown = app.remaining(true);
  if (!unknown.empty()) fail_unknown(unknown.front(), line, app, *parsed);
  if (line.quiet && line.verbose) throw UserError("--quiet contradicts --verbose: give only one of them");
  check_together(line, log_to_map, parsed_words(app));
  return line;
}

}  // namespace psi_slam
