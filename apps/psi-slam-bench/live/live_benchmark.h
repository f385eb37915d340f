// SPDX-License-Identifier: BSD-3-Clause
// Replays logs at the speed of their time stamps, as a robot would deliver the scans, and measures the time
// from a scan to its pose.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/workers.h"
#include "common/bench_report.h"
#include "psi_slam/frame.h"
#include "psi_slam/mapper.h"
#include "session/settings.h"
#include "sparse/sparse_logs.h"

namespace psi_slam {

struct LiveBenchmarkOptions {
  /// Replay speeds as multiples of the recorded speed; 0: as fast as possible.
  std::vector<double> speeds = {5, 0};
  std::vector<int> processors = {1, 2};  ///< numbers of processors that a run may use
  std::vector<double> simulated_m;       ///< path lengths of simulated runs, in metres
  double stretch_s = 0;                  ///< only the first seconds of each log are replayed; 0: all
  double timed_s = 0;                    ///< only the last seconds are paced and timed, see replay(); 0: all
  std::vector<std::string> assignments;  ///< "section.key=value": override the settings of every run
};

/// Replay of one log.
struct LiveRow {
  std::string log;
  double speed = 0;  ///< see LiveBenchmarkOptions::speeds
  int processors = 1;
  std::size_t scans = 0;
  std::size_t timed_scans = 0;  ///< number of scans that the following times are of
  std::size_t nodes = 0;
  /// Time from a scan to its pose, in milliseconds: from the moment when the scan is due, or when the program
  /// begins with it if the speed is 0.
  double mean_ms = 0;
  double p50_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
  std::size_t missed_deadlines = 0;  ///< Mapper::missed_deadlines()
  double cpu_ms = 0;                 ///< processor time of all threads per scan
  /// Mean translation errors over the relations, in metres: of the poses as the mapper gave them while
  /// mapping, of the map after the last scan before the final steps, and of the finished map. Empty without
  /// relations.
  std::optional<double> live_m;
  std::optional<double> mapped_m;
  std::optional<double> final_m;
};

struct LiveBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<LiveRow> rows;
};

/// Time at which each frame is due after the first one, in seconds, at the recorded speed. A step back in
/// time counts as no pause, and a longer pause than `longest_pause_s` as one of this length.
std::vector<double> due_times_s(const std::vector<Frame>& frames, double longest_pause_s = 2);

/// Poses and times of one replay.
struct Replayed {
  MappingResult result;
  std::vector<FrameRecord> live;    ///< the records right after each scan
  std::vector<FrameRecord> mapped;  ///< the records before the final steps, with the loops found until then
  std::vector<double> latency_ms;   ///< time from each timed scan to its pose
  std::size_t missed_deadlines = 0;
  double cpu_s = 0;  ///< processor time while the timed scans were added
};

/// Maps the frames as they become due, as psi-slam live does: with the journal and the map that it writes,
/// here to a temporary folder. Only the last `timed_s` seconds are timed (0: all); the scans before are
/// mapped as fast as possible, and the timed scans begin when the back end has worked them off and the map
/// shows them where they are. Throws UserError if there are no frames, and SystemFailure if the files cannot
/// be written.
Replayed replay(std::vector<Frame> frames, const Settings& settings, double speed,
                const std::function<void(double)>& progress, double timed_s = 0);

/// Replays all logs and simulated runs, each in a process of its own that uses the first `processors`
/// processors of the machine. Throws UserError as open_log() and read_relations().
LiveBenchmark run_live_benchmark(const SparseLogs& logs, const LiveBenchmarkOptions& options,
                                 const ProgressObserver& observer);

/// The report of the command `live`.
BenchReport live_report(const LiveBenchmark& benchmark, const LiveBenchmarkOptions& options,
                        const std::string& machine);

}  // namespace psi_slam
