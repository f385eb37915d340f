// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <ostream>

#include "base/scope_exit.h"
#include "commands.h"
#include "files_to_write.h"
#include "live/later_scans.h"
#include "live_mapping.h"
#include "live_run.h"
#include "psi_slam/user_error.h"
#include "session/session_input.h"
#include "session/session_prior.h"

namespace psi_slam {
namespace {

LivePose live_pose(const FrameRecord& record, std::size_t frame, const Mapper& mapper) {
  return {record.time_us, record.map_T_robot, frame, record.match == ScanMatch::kMatched,
          mapper.newest_covariance()};
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

}  // namespace

int map_live(const CommandLine& line, const Streams& streams) {
  const LiveInput source = live_input(line.live).value();
  const std::optional<PoseFormat> poses = pose_format(line.live);
  // Only poses go to standard output if there are any.
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  check_journal(line);
  OutputFolder::check(line.output, line.force);
  check_files_to_write(line);
  LiveRun run(texts, streams.err_is_terminal && !line.quiet,
              "mapping the scans that came before, then finishing the map. Interrupt again to finish it "
              "without more loops");
  BoundSettings bound;
  const SessionInput input = input_of(line, source, run.control(), bound, texts);
  const std::size_t resumed_scans = input.recording() ? input.recording()->frames.size() : 0;
  bound.settings.mapper.estimates_covariance = poses == PoseFormat::kJson;
  check_prior_apart(bound.settings, line.output);
  MappingSession session(input, bound.settings);
  const ScopeExit leave([&] { run.leave(); });  // the source ends before the session, also after an error
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  session.set_observer([&](const SessionProgress& progress) { run.show(progress); });
  if (poses)
    session.set_pose_observer([&](const FrameRecord& record) {
      const std::size_t frame = session.mapper().frames().size() - 1;
      if (frame >= resumed_scans) print_pose(streams.out, live_pose(record, frame, session.mapper()), *poses);
    });
  try {
    LiveMapping mapping(session, folder.path(), bound.settings, run.control().notify);
    while (mapping.step()) {
    }
  } catch (...) {
    if (resumed_scans == 0 && session.mapper().frames().empty())
      session.remove_journal();  // nothing could be resumed
    throw;
  }
  run.end();
  session.finish(run.cuts_short());
  return save_and_export(session, folder, line, texts, run.progress_line());
}

}  // namespace psi_slam
