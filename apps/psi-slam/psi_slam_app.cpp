// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam_app.h"

#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "closing_text.h"
#include "command_line.h"
#include "interrupt_signals.h"
#include "localize_command.h"
#include "log_check.h"
#include "progress_line.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/config/option_listing.h"
#include "psi_slam/results/output_folder.h"
#include "psi_slam/results/summary_json.h"
#include "psi_slam/session/bound_settings.h"
#include "psi_slam/session/mapping_session.h"

namespace psi_slam {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsageOrInput = 2;

/// The file's values, overridden by those of the command line.
void load(const CommandLine& line, BoundSettings& bound) {
  bound.load(line.config, line.settings);
  if (line.seed) bound.table.set("run.seed", *line.seed, "--seed");
  if (line.threads) bound.table.set("run.threads", *line.threads, "--threads");
  check(bound.settings);
}

std::string changed_settings(const OptionTable& table) {
  std::string lines;
  for (const OptionSection& section : table.sections())
    for (const Option& option : section.options)
      if (option.text() != option.default_text) lines += option.name() + " = " + option.text() + '\n';
  return lines;
}

void watch(MappingSession& session, const InterruptSignals& signals, const CommandLine& line,
           const Streams& streams, std::optional<ProgressLine>& progress_line) {
  if (streams.err_is_terminal && !line.quiet) progress_line.emplace(streams.err);
  session.set_observer([&, told = false](const SessionProgress& progress) mutable {
    if (!told && progress.phase == SessionProgress::Phase::kLastPass && signals.came()) {
      told = true;
      if (progress_line) progress_line->clear();
      streams.err << "psi-slam: interrupted, the map will show the " << progress.scans
                  << " scans read so far and the loops found so far (interrupt again to give up)\n";
    }
    if (progress_line) progress_line->show(progress);
  });
}

int map(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load(line, bound);
  if (line.verbose) streams.err << changed_settings(bound.table);
  const InterruptSignals signals;
  MappingSession session(line.log, bound.settings);
  if (!line.edits.empty()) session.set_edits(EditJournal::read(line.edits));
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  std::optional<ProgressLine> progress_line;
  watch(session, signals, line, streams, progress_line);
  session.run(signals.came());
  const RunSummary summary = session.export_to(folder);
  progress_line.reset();
  session.set_observer({});

  const RunInfo info = session.run_info();
  if (line.verbose) streams.err << stages_text(session.result());
  if (line.json)
    streams.out << summary_json(session.result(), info, summary);
  else if (!line.quiet)
    streams.out << closing_text(summary, info.log_name, folder);
  if (const SkippedLines skipped = session.skipped_lines(); skipped.count > 0 && !session.broken_off())
    streams.err << "psi-slam: " << skipped.sentence() << '\n';
  for (const std::string& unmet : session.unmet_edits())
    streams.err << "psi-slam: an edit was not made: " << unmet << '\n';
  if (const auto coarser = coarser_cells_text(summary.map)) streams.err << "psi-slam: " << *coarser << '\n';
  if (!session.broken_off()) return kDone;
  streams.err << "psi-slam: " << *session.broken_off() << "; the map shows the "
              << session.result().frames.size() << " scans that could be read\n";
  return kWrongUsageOrInput;
}

void dump_config(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load(line, bound);
  streams.out << settings_file_text(bound.table);
}

void explain_options(const CommandLine& line, const Streams& streams) {
  const BoundSettings bound;
  streams.out << (line.markdown ? markdown_reference(bound.table) : help_text(bound.table));
}

int run(const CommandLine& line, const Streams& streams) {
  int code = kDone;
  switch (line.command) {
    case CommandLine::Command::kMap:
      code = map(line, streams);
      break;
    case CommandLine::Command::kCheck: {
      BoundSettings bound;
      load(line, bound);
      const std::string broken_off = check_log(line.log, log_options(bound.settings), line.json, streams.out);
      if (!broken_off.empty()) {
        streams.err << "psi-slam: " << broken_off << '\n';
        code = kWrongUsageOrInput;
      }
      break;
    }
    case CommandLine::Command::kLocalize: {
      BoundSettings bound;
      load(line, bound);
      code = localize(line, bound.settings, streams);
      break;
    }
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
    return kDone;
  } catch (const CLI::ParseError& error) {
    streams.err << "psi-slam: " << error.what() << " (see psi-slam --help)\n";
    return kWrongUsageOrInput;
  } catch (const UserError& error) {
    streams.err << "psi-slam: " << error.what() << '\n';
    return kWrongUsageOrInput;
  } catch (const std::bad_alloc&) {
    streams.err << "psi-slam: there is not enough memory\n";
    return kFailed;
  } catch (const std::exception& error) {
    streams.err << "psi-slam: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace psi_slam
