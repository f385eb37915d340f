// SPDX-License-Identifier: BSD-3-Clause
#include <ostream>

#include "commands.h"
#include "live_run.h"
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

}  // namespace

int map_live(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  bound.settings.mapper.back_end_thread = true;
  const LiveInput source = live_input(line.live).value();
  const std::optional<PoseFormat> poses = pose_format(line.live);
  // Only poses go to standard output if there are any.
  const Streams texts{poses ? streams.err : streams.out, streams.err, streams.err_is_terminal};
  OutputFolder::check(line.output, line.force);
  LiveRun run(texts, streams.err_is_terminal && !line.quiet);
  MappingSession session(
      SessionInput(name_of(source),
                   [&](const LogOptions& options) { return open_live(source, options, run.control()); }),
      bound.settings);
  const Leaving leaving(run);
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  session.set_observer([&](const SessionProgress& progress) { run.show(progress); });

  while (session.step()) {
    // Here, after each scan, is the place for what follows the robot while it drives.
    if (poses) print_pose(streams.out, last_pose(session.mapper()), *poses);
  }

  if (run.end())
    streams.err << "psi-slam: finishing the map. Interrupt again to finish it without more loops\n";
  session.finish(run.interrupted());
  return save_and_export(session, folder, line, texts, run.progress_line());
}

}  // namespace psi_slam
