// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <ostream>

#include "base/exit_code.h"
#include "commands.h"
#include "live_run.h"
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

/// Localizes the robot at all frames, or until `is_interrupted`. Calls `after_scan` after each.
LocalizedLog localize_all(FrameSource& log, Localizer& localizer, const std::function<bool()>& is_interrupted,
                          const std::function<void(const std::vector<LocalizationStep>&)>& after_scan) {
  LocalizedLog result;
  try {
    while (const std::optional<Frame> frame = log.next()) {
      if (is_interrupted() && !result.steps.empty()) {
        result.interrupted = true;
        break;
      }
      result.steps.push_back(localizer.add(*frame));
      after_scan(result.steps);
    }
  } catch (const UserError& error) {
    if (result.steps.empty()) throw;
    result.broken_off = error.what();
  }
  return result;
}

/// Writes and prints the results. Returns the exit code.
int report(const LocalizedLog& localized, const FrameSource& log, const std::string& log_name,
           const std::vector<std::string>& calibration, const std::optional<OutputFolder>& folder,
           const CommandLine& line, const Streams& streams) {
  if (localized.steps.empty())
    throw UserError(
        log_name + ": no scan was read, so the robot cannot be localized. Check the log with psi-slam check");
  if (folder) write_localization(localized.steps, folder->path());
  LocalizationSummary summary = summarize(localized.steps);
  summary.interrupted = localized.interrupted;
  if (line.json)
    streams.out << localization_json(summary);
  else if (!line.quiet)
    streams.out << localization_text(summary);
  if (const SkippedLines skipped = log.skipped_lines(); skipped.count > 0 && !localized.broken_off)
    streams.err << "psi-slam: " << skipped.sentence() << '\n';
  for (const std::string& assumption : log.assumptions()) streams.err << "psi-slam: " << assumption << '\n';
  for (const std::string& sentence : calibration) streams.err << "psi-slam: " << sentence << '\n';
  if (localized.interrupted)
    streams.err << "psi-slam: interrupted: \"end of the log\" stands for the last of the " << summary.scans
                << " scans read so far\n";
  if (localized.broken_off) {
    streams.err << "psi-slam: " << *localized.broken_off << '\n';
    return kExitWrongUsageOrInput;
  }
  return summary.localized_at_end() ? kExitDone : kExitFailed;
}

std::optional<OutputFolder> prepare_folder(const CommandLine& line) {
  if (line.output.empty()) return std::nullopt;
  return OutputFolder::prepare(line.output, line.force);
}

int localize_in_log(const CommandLine& line, const Settings& settings, Localizer& localizer,
                    const Streams& streams) {
  const InterruptSignals signals;
  SessionInput input(line.log);
  calibrate(input, settings, line, signals, streams);
  const LogCalibration calibration = input.logs().back().calibration.value_or(LogCalibration());
  const auto log = open_log(line.log, calibrated_options(log_options(settings), calibration));
  const std::optional<OutputFolder> folder = prepare_folder(line);
  WorkProgress progress(streams.err_is_terminal && !line.quiet ? &streams.err : nullptr);
  const LocalizedLog localized = localize_all(
      *log, localizer, [&] { return signals.came().load(); },
      [&](const auto&) { progress.show("localizing", log->progress(), 1); });
  progress.clear();
  return report(localized, *log, line.log, calibration.sentences, folder, line, streams);
}

int localize_live(const CommandLine& line, const LiveInput& source, const Settings& settings,
                  Localizer& localizer, const Streams& streams) {
  const std::optional<PoseFormat> poses = pose_format(line.live);
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  LiveRun run(texts, false, "localizing at the scans that came before. Interrupt again to skip them");
  const auto frames = open_live(source, log_options(settings), run.control());
  const std::optional<OutputFolder> folder = prepare_folder(line);
  const LocalizedLog localized = localize_all(
      *frames, localizer, [&] { return run.interrupted_twice(); },
      [&](const std::vector<LocalizationStep>& steps) {
        const LocalizationStep& last = steps.back();
        if (poses && last.state == LocalizationStep::State::kTracking)
          print_pose(streams.out, {last.time_us, last.map_T_robot, steps.size() - 1, last.fits}, *poses);
      });
  run.end();
  return report(localized, *frames, name_of(source), {}, folder, line, texts);
}

}  // namespace

int localize(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  Localizer localizer(read_map_file(line.map), localizer_options(bound.settings));
  if (!line.start.empty()) localizer.start_at(parse_start(line.start));
  if (!line.output.empty()) OutputFolder::check(line.output, line.force);
  if (const auto source = live_input(line.live))
    return localize_live(line, *source, bound.settings, localizer, streams);
  return localize_in_log(line, bound.settings, localizer, streams);
}

}  // namespace psi_slam
