// SPDX-License-Identifier: BSD-3-Clause
// Runs of a robot whose maps can be compared with the truth: simulated runs, and logs with true relations.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/random_draws.h"
#include "common/benchmark_logs.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// What is known about a log: the poses in the map of the whole log, and its true relations.
struct LogTruth {
  Trajectory map;  ///< of all scans of the log
  std::vector<Relation> relations;
};

/// A run, possibly degraded, with its truth.
struct KnownRun {
  std::string log;  ///< name of the log; empty for a simulated run
  MapperOptions mapper;
  std::vector<Frame> frames;
  /// Poses at the frames: the truth of a simulated run, or the poses in the map of the whole log.
  std::vector<mrpt::math::TPose2D> world_T_robot;
  std::vector<std::size_t> scans;         ///< number of each frame in the run before it was degraded
  std::size_t kept_every_nth = 1;         ///< of the scans before the run was degraded
  std::shared_ptr<const LogTruth> truth;  ///< empty for a simulated run
};

/// Simulates a run of path_m metres with people and range noise that `draws` decides.
KnownRun simulated_run(std::uint64_t seed, double path_m, RandomDraws& draws);

/// Reads and maps a log with relations. Returns its run and its map. Throws UserError as open_log() and
/// read_relations().
std::pair<KnownRun, MappingResult> run_of_log(const BenchmarkLog& log);

/// Maps the frames of a run.
MappingResult map_of(const KnownRun& run, bool close_loops = true);

/// Mean error of the positions of a map of the run, metres. Of a simulated run: aligned_error_m(). Of a log:
/// mean translational error over its relations; scans that were thinned out are put back by the map of the
/// whole log.
double mean_error_m(const MappingResult& map, const KnownRun& run);

/// Keeps every nth frame, cuts ranges, and adds a random walk to odometry.
KnownRun degraded(const KnownRun& run, std::size_t keep_every_nth, double max_range_m, double noise,
                  RandomDraws& draws);

/// Makes the laser blind in the frames [from, to). In the middle of them, the wheels slip.
void slip(KnownRun& run, std::size_t from, std::size_t to, const mrpt::math::TPose2D& slipped);

/// Removes the frames [off, on): the robot was switched off and moved. Odometry goes on as if it had stood.
void carry(KnownRun& run, std::size_t off, std::size_t on);

/// Delays the frames from `at` on by pause_s and begins odometry again at zero: the robot was switched off
/// and on where it stood.
void pause(KnownRun& run, std::size_t at, double pause_s);

/// Index of the first frame that is `path_m` metres of path after the frame `from`; the last frame if the run
/// is shorter.
std::size_t frame_after(const KnownRun& run, std::size_t from, double path_m);

}  // namespace psi_slam
