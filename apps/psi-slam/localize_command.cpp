// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <ostream>

#include "base/exit_code.h"
#include "base/number_text.h"
#include "commands.h"
#include "files_to_write.h"
#include "live_run.h"
#include "localization/localization_report.h"
#include "localization/reference_map.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "ros2_run.h"
#include "session/log_calibration.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct LocalizedLog {
  std::vector<LocalizationStep> steps;
  bool interrupted = false;
  std::optional<std::string> broken_off;
};

/// Localizes the robot at all frames, or until `is_interrupted`. Calls `after_scan` after each.
LocalizedLog localize_all(
    FrameSource& log, Localizer& localizer, const std::function<bool()>& is_interrupted,
    const std::function<void(const Frame&, const std::vector<LocalizationStep>&)>& after_scan) {
  LocalizedLog result;
  try {
    while (const std::optional<Frame> frame = log.next()) {
      if (is_interrupted() && !result.steps.empty()) {
        result.interrupted = true;
        break;
      }
      result.steps.push_back(localizer.add(*frame));
      after_scan(*frame, result.steps);
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
      [&](const auto&, const auto&) { progress.show("localizing", log->progress(), 1); });
  progress.clear();
  return report(localized, *log, line.log, calibration.sentences, folder, line, streams);
}

/// Tells other nodes where the robot is, and obeys their commands.
class LocalizationNode {
 public:
  LocalizationNode(std::shared_ptr<Ros2Link> link, const mrpt::maps::COccupancyGridMap2D& map)
      : link_(std::move(link)), commands_(link_) {
    link_->publish_map(map);
    link_->initial_pose();  // one that came while mapping is out of date
  }

  LiveControl control(LiveControl control) {
    control = commands_.control(std::move(control));
    control.should_stop = [this, stop = std::move(control.should_stop)] {
      commands_.take([](const std::string&, const std::string&) { return std::optional<std::string>(); });
      return stop();
    };
    return control;
  }

  /// Takes a start pose that a user has stated meanwhile. Call between scans.
  void take_start(Localizer& localizer) {
    if (const auto start = link_->initial_pose()) {
      localizer.start_at(*start);
      link_->answer("initialpose: searching near the given pose");
    }
  }

  void show(const Frame& frame, const LocalizationStep& step) {
    const bool is_tracking = step.state == LocalizationStep::State::kTracking;
    if (is_tracking)
      link_->publish_pose({frame.time_us, step.map_T_robot,
                           frame.has_odometry ? std::optional(frame.odom_T_robot) : std::nullopt,
                           std::nullopt});
    if (was_tracking_ == is_tracking && frame.time_us < status_due_us_) return;
    was_tracking_ = is_tracking;
    status_due_us_ = frame.time_us + 1'000'000;
    link_->publish_status({is_tracking ? Ros2Status::Level::kGood : Ros2Status::Level::kWarning,
                           is_tracking ? "localized" : "searching for the robot in the map",
                           {{"confidence", trimmed_text(step.confidence, 3)}}});
  }

 private:
  std::shared_ptr<Ros2Link> link_;
  Ros2Commands commands_;
  bool was_tracking_ = false;
  TimeUs status_due_us_ = 0;
};

}  // namespace

int localize_live(const CommandLine& line, const LiveInput& given, const Settings& settings,
                  const std::optional<TPose2D>& start, const Streams& streams) {
  const std::optional<PoseFormat> poses = pose_format(line.live);
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  const mrpt::maps::COccupancyGridMap2D map = read_map_file(line.map);
  Localizer localizer(map, localizer_options(settings));
  if (start) localizer.start_at(*start);
  LiveRun run(texts, false, "localizing at the scans that came before. Interrupt again to skip them");
  LiveInput source = given;
  std::optional<LocalizationNode> node;
  if (source.kind == LiveInput::Kind::kRos2) {
    if (!source.ros2_link) source.ros2_link = open_ros2_link(source.ros2);
    node.emplace(source.ros2_link, map);
  }
  const auto frames =
      open_live(source, log_options(settings), node ? node->control(run.control()) : run.control());
  const std::optional<OutputFolder> folder = prepare_folder(line);
  const auto after_scan = [&](const Frame& frame, const std::vector<LocalizationStep>& steps) {
    const LocalizationStep& last = steps.back();
    if (poses && last.state == LocalizationStep::State::kTracking)
      print_pose(streams.out, {last.time_us, last.map_T_robot, steps.size() - 1, last.fits}, *poses);
    if (!node) return;
    node->show(frame, last);
    node->take_start(localizer);
  };
  const LocalizedLog localized = localize_all(
      *frames, localizer, [&] { return run.interrupted_twice(); }, after_scan);
  run.end();
  return report(localized, *frames, name_of(source), {}, folder, line, texts);
}

int localize(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  std::optional<TPose2D> start;
  if (!line.start.empty()) start = parse_start(line.start);
  if (!line.output.empty()) OutputFolder::check(line.output, line.force);
  check_files_to_write(line);
  if (auto source = live_input(line.live)) {
    source->replaces_record = line.force;
    return localize_live(line, *source, bound.settings, start, streams);
  }
  Localizer localizer(read_map_file(line.map), localizer_options(bound.settings));
  if (start) localizer.start_at(*start);
  return localize_in_log(line, bound.settings, localizer, streams);
}

}  // namespace psi_slam
