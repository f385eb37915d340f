// SPDX-License-Identifier: BSD-3-Clause
#include <ostream>

#include "base/exit_code.h"
#include "commands.h"
#include "localization/localization_report.h"
#include "localization/reference_map.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "session/log_calibration.h"

namespace psi_slam {
namespace {

struct LocalizedLog {
  std::vector<LocalizationStep> steps;
  bool interrupted = false;
  std::optional<std::string> broken_off;
};

LocalizedLog localize_all(FrameSource& log, Localizer& localizer, const InterruptSignals& signals,
                          WorkProgress progress) {
  LocalizedLog result;
  try {
    while (const std::optional<Frame> frame = log.next()) {
      if (signals.came() && !result.steps.empty()) {
        result.interrupted = true;
        break;
      }
      result.steps.push_back(localizer.add(*frame));
      progress.show("localizing", log.progress(), 1);
    }
  } catch (const UserError& error) {
    if (result.steps.empty()) throw;
    result.broken_off = error.what();
  }
  return result;
}

}  // namespace

int localize(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  Localizer localizer(read_map_file(line.map), localizer_options(bound.settings));
  if (!line.start.empty()) localizer.start_at(parse_start(line.start));
  if (!line.output.empty()) OutputFolder::check(line.output, line.force);
  const InterruptSignals signals;
  SessionInput input(line.log);
  calibrate(input, bound.settings, line, signals, streams);
  const LogCalibration calibration = input.logs().back().calibration.value_or(LogCalibration());
  const auto log = open_log(line.log, calibrated_options(log_options(bound.settings), calibration));
  std::optional<OutputFolder> folder;
  if (!line.output.empty()) folder = OutputFolder::prepare(line.output, line.force);

  const LocalizedLog localized =
      localize_all(*log, localizer, signals,
                   WorkProgress(streams.err_is_terminal && !line.quiet ? &streams.err : nullptr));
  if (localized.steps.empty())
    throw UserError(
        line.log + ": no scan was read, so the robot cannot be localized. Check the log with psi-slam check");
  if (folder) write_localization(localized.steps, folder->path());
  LocalizationSummary summary = summarize(localized.steps);
  summary.interrupted = localized.interrupted;
  if (line.json)
    streams.out << localization_json(summary);
  else if (!line.quiet)
    streams.out << localization_text(summary);
  if (const SkippedLines skipped = log->skipped_lines(); skipped.count > 0 && !localized.broken_off)
    streams.err << "psi-slam: " << skipped.sentence() << '\n';
  for (const std::string& assumption : log->assumptions()) streams.err << "psi-slam: " << assumption << '\n';
  for (const std::string& sentence : calibration.sentences) streams.err << "psi-slam: " << sentence << '\n';
  if (localized.interrupted)
    streams.err << "psi-slam: interrupted: \"end of the log\" stands for the last of the " << summary.scans
                << " scans read so far\n";
  if (localized.broken_off) {
    streams.err << "psi-slam: " << *localized.broken_off << '\n';
    return kExitWrongUsageOrInput;
  }
  return summary.localized_at_end() ? kExitDone : kExitFailed;
}

}  // namespace psi_slam
