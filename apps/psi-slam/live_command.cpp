// SPDX-License-Identifier: BSD-3-Clause
#include <ostream>

#include "commands.h"
#include "exports/live_map_writer.h"
#include "failure_notice.h"
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

LivePose last_pose(const Mapper& mapper) {
  const FrameRecord& record = mapper.frames().back();
  return {record.time_us, record.map_T_robot, mapper.frames().size() - 1,
          record.match == ScanMatch::kMatched};
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

/// Maps until the source ends. Tells at once when the journal or the map cannot be written.
void map_to_the_end(MappingSession& session, const OutputFolder& folder, const Settings& settings,
                    const std::function<void(const Mapper&)>& after_scan, const LiveControl& control) {
  LiveMapWriter map(folder.path(), settings.map, settings.live.map_period_s);
  FailureNotice of_journal("the journal");
  FailureNotice of_map("the map");
  while (session.step()) {
    after_scan(session.mapper());
    map.update(session.mapper());
    if (const auto news = of_journal.news(session.journal_failure())) control.notify(*news);
    if (const auto news = of_map.news(map.failure())) control.notify(*news);
  }
}

}  // namespace

int map_live(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
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

  session.start_journal(journal);
  const auto after_scan = [&](const Mapper& mapper) {
    if (poses) print_pose(streams.out, last_pose(mapper), *poses);
  };
  try {
    map_to_the_end(session, folder, bound.settings, after_scan, run.control());
  } catch (...) {
    if (session.mapper().frames().empty()) session.remove_journal();  // nothing could be resumed
    throw;
  }
  run.end();
  session.finish(run.cuts_short());
  return save_and_export(session, folder, line, texts, run.progress_line());
}

}  // namespace psi_slam
