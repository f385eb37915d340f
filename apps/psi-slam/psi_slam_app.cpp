// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam_app.h"

#include <ostream>

#include "base/exit_code.h"
#include "commands.h"
#include "run_program.h"

namespace psi_slam {
namespace {

int dump_config(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  streams.out << settings_file_text(bound.table);
  return kExitDone;
}

int run(const CommandLine& line, const Streams& streams) {
  switch (line.command) {
    case CommandLine::Command::kMap:
      return map_log(line, streams);
    case CommandLine::Command::kCheck:
      return check_log(line, streams);
    case CommandLine::Command::kDiff:
      return compare_maps(line, streams);
    case CommandLine::Command::kEval:
      return evaluate_path(line, streams);
    case CommandLine::Command::kLocalize:
      return localize(line, streams);
    case CommandLine::Command::kLive:
      return map_live(line, streams);
    case CommandLine::Command::kMerge:
      return merge_runs(line, streams);
    case CommandLine::Command::kPlay:
      return play_log(line, streams);
    case CommandLine::Command::kOptions:
      return explain_options(line, streams);
    case CommandLine::Command::kDumpConfig:
      return dump_config(line, streams);
    case CommandLine::Command::kSweep:
      return run_sweep_command(line.sweep, "/proc/self/exe", streams);
    case CommandLine::Command::kOtherProgram:
      become(*line.other_program, line.other_arguments);
  }
  return kExitFailed;
}

}  // namespace

int run_psi_slam_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept {
  CLI::App app("psi-slam draws floor plans from the scans of a 2D lidar and wheel odometry.", "psi-slam");
  int failed = kExitFailed;
  const auto work = [&] {
    const CommandLine line = parse_command_line(arguments, app);
    if (line.command == CommandLine::Command::kDiff) failed = kExitNotCompared;
    return run(line, streams);
  };
  return run_program(app, streams.out, streams.err, work, failed);
}

}  // namespace psi_slam
