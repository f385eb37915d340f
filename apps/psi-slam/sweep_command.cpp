// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_command.h"

#include <map>
#include <ostream>

#include "base/file_checksum.h"
#include "base/number_text.h"
#include "batch/sweep_report.h"
#include "document_options.h"
#include "interrupt_signals.h"
#include "progress_line.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr int kMostThreads = 1024;

/// Adds an option that may be repeated, with one value each time.
void add_repeated(CLI::App& command, const std::string& name, std::vector<std::string>& texts,
                  const std::string& help, const std::string& type) {
  add_value(command, name, texts, help + ". May be repeated", type)->allow_extra_args(false);
}

/// Adds an option for a number from 1 to kMostThreads.
void add_count(CLI::App& command, const std::string& name, int& number, const std::string& help) {
  add_value(command, name, number, help, "N")
      ->check(CLI::Range(1, kMostThreads).description(""))
      ->capture_default_str();
}

SweepKeep parse_keep(const std::string& text) {
  static const std::map<std::string, SweepKeep> kKeeps{
      {"none", SweepKeep::kNone}, {"paths", SweepKeep::kPaths}, {"maps", SweepKeep::kMaps}};
  const auto found = kKeeps.find(text);
  if (found == kKeeps.end()) throw UserError("--keep " + text + ": expected none, paths or maps");
  return found->second;
}

std::string closing_text(const SweepResult& result, const fs::path& folder) {
  const std::size_t made = result.made_now();
  const std::size_t finished = result.outcomes.size() - result.to_go() - result.failed();
  return std::to_string(finished) + " of " + std::to_string(result.outcomes.size()) + " runs are finished, " +
         std::to_string(made) + " made now. " + (folder / "report.html").string() + " compares them and " +
         (folder / "sweep.csv").string() + " lists them.\n";
}

}  // namespace

void add_sweep_options(CLI::App& command, SweepArguments& arguments) {
  SweepRequest& request = arguments.request;
  add_value(command, "LOG", request.logs, "Logs to map. LOG@INI gives a log its own settings", "");
  add_value(command, "-o,--output", arguments.output,
            "Folder for runs and report. Runs that it already holds are not repeated", "DIR");
  add_value(command, "--ini", request.ini_folder,
            "Folder with the settings NAME.ini of each log. Default: the folder of the log", "DIR");
  add_value(command, "--relations", request.relations,
            "Relations (known relative poses) of a single log. Default: NAME.relations beside each log",
            "FILE");
  add_repeated(command, "-c,--config", request.configs,
               "Settings file to compare; overrides the settings of the log", "INI");
  add_repeated(command, "--set", request.choices, "Values of an option to compare", "SECTION.KEY=VALUE,...");
  command
      .add_option_function<std::string>(
          "--seeds", [&request](const std::string& text) { request.seeds = parse_seeds(text); },
          "Seeds of the runs with each setting: N means 1 to N; or FIRST-LAST")
      ->default_str("1")
      ->type_name("SEEDS");
  command
      .add_option_function<std::string>(
          "--keep", [&arguments](const std::string& text) { arguments.keep = parse_keep(text); },
          "What to keep of each run: none (only summary and settings), paths (also tables), maps "
          "(everything)")
      ->default_str("none")
      ->type_name("WHAT");
  add_count(command, "--threads", request.threads, "Threads of each run");
  command.add_flag("-q,--quiet", arguments.quiet, "Print only warnings and errors");
  add_count(command, "--processes", arguments.processes,
            "Number of runs at a time. More runs than processors make the times unreliable");
}

int run_sweep_command(const SweepArguments& arguments, const fs::path& program, const Streams& streams) {
  const fs::path folder = arguments.output;
  if (folder.empty()) throw UserError("name the folder for the results: -o DIR (see psi-slam sweep --help)");
  std::error_code failed;
  if (fs::is_directory(folder, failed) && !fs::is_empty(folder, failed) &&
      !fs::is_directory(folder / "runs", failed))
    throw UserError("the output folder " + folder.string() +
                    " is not empty and holds no sweep. Name a new folder, or that of a sweep");
  fs::create_directories(folder / "runs", failed);
  if (failed) throw UserError("cannot make the folder " + folder.string() + ": " + failed.message());
  const SweepPlan plan = plan_sweep(arguments.request, sha256_of_file(program));
  for (const std::string& warning : plan.warnings) streams.err << "psi-slam: " << warning << '\n';
  const SweepLock lock(folder);
  const InterruptSignals signals;
  SweepResult result;
  {
    WorkProgress progress(streams.err_is_terminal && !arguments.quiet ? &streams.err : nullptr);
    result = run_sweep(
        plan, {folder, arguments.keep, program}, arguments.processes, [&] { return signals.came().load(); },
        [&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
  }
  write_sweep_report(plan, result, folder);
  if (!arguments.quiet) streams.out << closing_text(result, folder);
  if (result.to_go() > 0)
    throw SystemFailure("interrupted with " + std::to_string(result.to_go()) +
                        " runs left. The same command resumes the sweep");
  if (result.failed() > 0)
    throw SystemFailure(counted(result.failed(), "run") + " failed. " + (folder / "report.html").string() +
                        " lists them with the reasons");
  return 0;
}

}  // namespace psi_slam
