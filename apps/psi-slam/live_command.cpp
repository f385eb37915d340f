// SPDX-License-Identifier: BSD-3-Clause
#include <ostream>

#include "commands.h"
#include "exports/live_map_writer.h"
#include "live_run.h"
#include "psi_slam/user_error.h"
#include "session/session_input.h"

namespace psi_slam {
namespace {

/// Lets the source of a session end before the session is destroyed, also after an error.
class Leaving {
 public:
  explicit Leaving(LiveRun& run) : run_(run) {}
  ~Leaving() { run_.leave(); }
  Leaving(const Leaving&) = delete;
  Leaving& operator=(const Leaving&) = delete;

 private:
  LiveRun& run_;
};

LivePose live_pose(const FrameRecord& record, std::size_t frame) {
  return {record.time_us, record.map_T_robot, frame, record.match == ScanMatch::kMatched};
}

/// Returns the journal of a live run, which lies in the folder of its results. Throws UserError if the folder
/// has a journal of a run that was not finished.
std::filesystem::path journal_in(const std::filesystem::path& folder) {
  const std::filesystem::path journal = folder / "session.journal";
  if (std::filesystem::exists(journal))
    throw UserError(journal.string() +
                    " holds a run that was not finished. Finish it with psi-slam --resume " +
                    journal.string() + " -o ANOTHER_FOLDER, or delete it");
  return journal;
}

/// Maps until the source ends. Returns why the map could not be written the last time; empty if it was.
std::optional<std::string> map_to_the_end(MappingSession& session, const OutputFolder& folder,
                                          const Settings& settings) {
  LiveMapWriter map(folder.path(), settings.map, settings.live.map_period_s);
  while (session.step()) map.update(session.mapper());
  return map.failure();
}

}  // namespace

int map_live(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  bound.settings.mapper.back_end_thread = bound.settings.mapper.back_end_yields = true;
  const LiveInput source = live_input(line.live).value();
  const std::optional<PoseFormat> poses = pose_format(line.live);
  // Only poses go to standard output if there are any.
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  const std::filesystem::path journal = journal_in(line.output);
  OutputFolder::check(line.output, line.force);
  check_sessions_to_write(line);
  LiveRun run(texts, streams.err_is_terminal && !line.quiet,
              "mapping the scans that came before, then finishing the map. Interrupt again to finish it "
              "without more loops");
  MappingSession session(
      SessionInput(name_of(source),
                   [&](const LogOptions& options) { return open_live(source, options, run.control()); }),
      bound.settings);
  const Leaving leaving(run);
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  session.set_observer([&](const SessionProgress& progress) { run.show(progress); });
  if (poses)
    session.set_pose_observer([&](const FrameRecord& record) {
      print_pose(streams.out, live_pose(record, session.mapper().frames().size() - 1), *poses);
    });

  session.start_journal(journal);
  std::optional<std::string> unwritten;
  try {
    unwritten = map_to_the_end(session, folder, bound.settings);
  } catch (...) {
    if (session.mapper().frames().empty()) session.remove_journal();  // nothing could be resumed
    throw;
  }
  if (unwritten) streams.err << "psi-slam: the map was not written while mapping: " << *unwritten << '\n';
  run.end();
  session.finish(run.cuts_short());
  return save_and_export(session, folder, line, texts, run.progress_line());
}

}  // namespace psi_slam
