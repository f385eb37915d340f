// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <ostream>

#include "base/exit_code.h"
#include "base/scope_exit.h"
#include "commands.h"
#include "files_to_write.h"
#include "live/later_scans.h"
#include "live_mapping.h"
#include "live_run.h"
#include "psi_slam/user_error.h"
#include "ros2_run.h"
#include "session/session_input.h"
#include "session/session_prior.h"
#include "site_run.h"

namespace psi_slam {
namespace {

LivePose live_pose(const FrameRecord& record, std::size_t frame, const Mapper& mapper) {
  return {record.time_us, record.map_T_robot, frame, record.match == ScanMatch::kMatched,
          mapper.newest_covariance()};
}

/// Pose of the robot by its own odometry at the newest scan; empty if it has none. The record of a later run
/// continues the odometry of the first run instead.
std::optional<mrpt::math::TPose2D> odometry_of(const Mapper& mapper) {
  const Frame& frame = mapper.log().back();
  return frame.has_odometry ? std::optional(frame.odom_T_robot) : std::nullopt;
}

/// Throws UserError if the folder of the results has a journal of a run that was not finished, unless that
/// run is resumed.
void check_journal(const CommandLine& line) {
  namespace fs = std::filesystem;
  const fs::path journal = journal_of_live_run(line.output);
  std::error_code ignored;
  if (!fs::exists(journal) || (!line.resume.empty() && fs::equivalent(journal, line.resume, ignored))) return;
  throw UserError(journal.string() + " holds a run that was not finished. Finish it with psi-slam --resume " +
                  journal.string() + " -o ANOTHER_FOLDER, or delete it");
}

/// Returns the input of a live run: the source, or the session of --resume and then the source. Loads the
/// settings of the run into `bound`.
SessionInput input_of(const CommandLine& line, const LiveInput& source, const LiveControl& control,
                      BoundSettings& bound, const Streams& streams) {
  const auto open = [=](const LogOptions& options) { return open_live(source, options, control); };
  if (line.resume.empty()) {
    load_settings(line, bound, streams);
    return SessionInput(name_of(source), open);
  }
  const auto recording = read_resumed(line, bound, streams);
  if (recording->frames.empty()) return SessionInput(recording, name_of(source), open);
  return SessionInput(recording, name_of(source), [=](const LogOptions& options) {
    return std::make_unique<LaterScans>(open(options), recording->frames.front().time_us,
                                        recording->frames.back().time_us, control);
  });
}

/// Returns the recording for the run after a reset or localize: "run-1.mcap", or the first number whose file
/// does not exist.
std::string further_recording(const std::filesystem::path& first) {
  if (first.empty()) return {};
  for (int number = 1;; ++number) {
    const std::filesystem::path file =
        first.parent_path() /
        (first.stem().string() + '-' + std::to_string(number) + first.extension().string());
    if (!std::filesystem::exists(file)) return file.string();
  }
}

/// Environment of a live run, shared by the maps before and after a reset.
struct LiveEnvironment {
  const CommandLine& line;
  const LiveInput& source;
  const Settings& settings;
  std::optional<OutputFolder>& folder;  ///< prepared when the source is open
  const Streams& streams;               ///< of poses
  const Streams& texts;                 ///< of everything else
  std::optional<PoseFormat> poses;      ///< of the lines of poses; empty: none
};

/// Tells the receivers of poses about a scan.
void send_pose(const LiveEnvironment& live, const FrameRecord& record, std::size_t frame,
               const Mapper& mapper) {
  if (live.poses) print_pose(live.streams.out, live_pose(record, frame, mapper), *live.poses);
  if (live.source.ros2_link)
    live.source.ros2_link->publish_pose(
        {record.time_us, record.map_T_robot, odometry_of(mapper), mapper.newest_covariance()});
}

/// Maps until the source ends or a command ends the map. Returns the exit code; empty if the map is dropped.
std::optional<int> make_map(const LiveEnvironment& live, const SessionInput& input, Ros2Commands* commands,
                            LiveRun& run, std::optional<mrpt::math::TPose2D>& last_pose) {
  Ros2Link* const link = live.source.ros2_link.get();
  const std::size_t resumed_scans = input.recording() ? input.recording()->frames.size() : 0;
  MappingSession session(input, live.settings);
  const ScopeExit leave([&] { run.leave(); });  // the source ends before the session, also after an error
  if (!live.folder) live.folder = OutputFolder::prepare(live.line.output, live.line.force);
  const OutputFolder& folder = *live.folder;
  session.set_observer([&](const SessionProgress& progress) { run.show(progress); });
  if (live.poses || link != nullptr)
    session.set_pose_observer([&](const FrameRecord& record) {
      const std::size_t frame = session.mapper().frames().size() - 1;
      if (frame >= resumed_scans) send_pose(live, record, frame, session.mapper());
    });
  try {
    LiveMapWriter::ShowMap show_map;
    if (link != nullptr) show_map = [link](const auto& map) { link->publish_map(map); };
    LiveMapping mapping(session, folder.path(), live.settings, run.control().notify, show_map);
    std::optional<Ros2Run> ros2;
    if (link != nullptr) ros2.emplace(live.source.ros2_link, *commands, session, mapping, folder.path());
    do {
      if (ros2) ros2->wait_for_scan();
    } while (mapping.step());
  } catch (...) {
    if (!session.mapper().frames().empty()) throw;
    if (resumed_scans == 0) session.remove_journal();  // nothing could be resumed
    if (commands != nullptr && commands->wish() == Ros2Wish::kReset) return std::nullopt;
    throw;
  }
  if (commands != nullptr && commands->wish() == Ros2Wish::kReset) {
    session.remove_journal();
    return std::nullopt;
  }
  run.end();
  session.finish(run.cuts_short());
  const auto publish = [&](const RunSummary& summary) {
    if (link == nullptr) return;
    Ros2Run::publish_result(*link, session, summary, folder.path());
    session.read_exported([&](const MappingResult& result) { last_pose = result.frames.back().map_T_robot; });
  };
  return save_and_export(session, folder, live.line, live.texts, run.progress_line(), publish);
}

}  // namespace

int map_live(const CommandLine& given, const Streams& streams) {
  CommandLine line = given;
  LiveInput source = live_input(line.live).value();
  source.replaces_record = line.force;
  continue_site(line, name_of(source));
  const std::optional<PoseFormat> poses = pose_format(line.live);
  // Only poses go to standard output if there are any.
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  check_journal(line);
  OutputFolder::check(line.output, line.force);
  check_files_to_write(line);
  std::optional<Ros2Commands> commands;
  if (source.kind == LiveInput::Kind::kRos2) {
    source.ros2_link = open_ros2_link(source.ros2);
    commands.emplace(source.ros2_link);
  }
  std::optional<OutputFolder> folder;
  while (true) {
    BoundSettings bound;
    std::optional<mrpt::math::TPose2D> last_pose;
    std::optional<int> code;
    {
      LiveRun run(texts, streams.err_is_terminal && !line.quiet,
                  "mapping the scans that came before, then finishing the map. Interrupt again to finish it "
                  "without more loops");
      const LiveControl control = commands ? commands->control(run.control()) : run.control();
      const SessionInput input = input_of(line, source, control, bound, texts);
      bound.settings.mapper.estimates_covariance = poses == PoseFormat::kJson || source.ros2_link;
      check_prior_apart(bound.settings, line.output);
      const LiveEnvironment live{line, source, bound.settings, folder, streams, texts, poses};
      code = make_map(live, input, commands ? &*commands : nullptr, run, last_pose);
    }
    const Ros2Wish wish = commands ? commands->wish() : Ros2Wish::kGoOn;
    if (code && wish != Ros2Wish::kLocalize) return *code;
    commands->set_wish(Ros2Wish::kGoOn);
    source.record = further_recording(line.live.record);
    line.resume.clear();
    if (!code) continue;
    line.map = (folder->path() / "map.yaml").string();
    line.output.clear();
    const int localized = localize_live(line, source, bound.settings, last_pose, streams);
    return *code == kExitDone ? localized : *code;
  }
}

}  // namespace psi_slam
