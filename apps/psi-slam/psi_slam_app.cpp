// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam_app.h"

#include <new>
#include <ostream>

#include "command_line.h"
#include "localize_command.h"
#include "log_check.h"
#include "map_command.h"
#include "merge_command.h"
#include "base/exit_code.h"
#include "psi_slam/user_error.h"
#include "config/option_listing.h"
#include "session/bound_settings.h"

namespace psi_slam {
namespace {

void dump_config(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound);
  streams.out << settings_file_text(bound.table);
}

void explain_options(const CommandLine& line, const Streams& streams) {
  const BoundSettings bound;
  streams.out << (line.markdown ? markdown_reference(bound.table) : help_text(bound.table));
}

int run(const CommandLine& line, const Streams& streams) {
  int code = kExitDone;
  switch (line.command) {
    case CommandLine::Command::kMap:
      code = map_log(line, streams);
      break;
    case CommandLine::Command::kCheck: {
      BoundSettings bound;
      load_settings(line, bound);
      const std::string broken_off = check_log(line.log, log_options(bound.settings), line.json, streams.out);
      if (!broken_off.empty()) {
        streams.err << "psi-slam: " << broken_off << '\n';
        code = kExitWrongUsageOrInput;
      }
      break;
    }
    case CommandLine::Command::kLocalize: {
      BoundSettings bound;
      load_settings(line, bound);
      code = localize(line, bound.settings, streams);
      break;
    }
    case CommandLine::Command::kMerge:
      code = merge_runs(line, streams);
      break;
    case CommandLine::Command::kOptions:
      explain_options(line, streams);
      break;
    case CommandLine::Command::kDumpConfig:
      dump_config(line, streams);
      break;
    case CommandLine::Command::kSweep:
      code = run_sweep_command(line.sweep, local_workers(line.sweep.processes), "/proc/self/exe", streams);
      break;
  }
  streams.out.flush();
  if (!streams.out) throw SystemFailure("cannot write to standard output");
  return code;
}

}  // namespace

int run_psi_slam_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept {
  CLI::App app("psi-slam draws floor plans from the scans of a 2D lidar and wheel odometry.", "psi-slam");
  try {
    return run(parse_command_line(arguments, app), streams);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, streams.out, streams.err);
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    streams.err << "psi-slam: " << error.what() << " (see psi-slam --help)\n";
    return kExitWrongUsageOrInput;
  } catch (const UserError& error) {
    streams.err << "psi-slam: " << error.what() << '\n';
    return kExitWrongUsageOrInput;
  } catch (const std::bad_alloc&) {
    streams.err << "psi-slam: there is not enough memory\n";
    return kExitFailed;
  } catch (const std::exception& error) {
    streams.err << "psi-slam: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace psi_slam
