// SPDX-License-Identifier: BSD-3-Clause
// Which scans of a log to compare with each other, decided by odometry alone, and fetching those in one more
// pass.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "doctor/log_facts.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Two frames by their indices, the earlier first.
struct FramePair {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// How the robot stands at `second`, seen from `first`, by odometry.
mrpt::math::TPose2D odometry_between(const std::vector<FrameMark>& marks, const FramePair& pair);

/// Sums of turns by odometry, radians, not wrapped: [i] from frame 0 to frame i.
std::vector<double> unwrapped_headings(const std::vector<FrameMark>& marks);

/// Up to `count` frames at which odometry moves or turns, spread evenly over all motion in the log; no unit
/// of odometry is presumed. Spread over time when odometry never moves.
std::vector<std::size_t> frames_in_motion(const std::vector<FrameMark>& marks, std::size_t count);

/// Pairs one after the other, each `distance_m` or `turn_rad` apart; evenly thinned to `most`.
std::vector<FramePair> pairs_by_motion(const std::vector<FrameMark>& marks, double distance_m,
                                       double turn_rad, std::size_t most);

/// Pairs that turn by min ... max without moving further than `distance_m`; evenly thinned to `most`.
std::vector<FramePair> pairs_by_turn(const std::vector<FrameMark>& marks, double min_turn_rad,
                                     double max_turn_rad, double distance_m, std::size_t most);

/// Pairs at which odometry has returned to within `distance_m` and `turn_rad` of an earlier place after a way
/// of at least `way_m`; evenly thinned to `most`.
std::vector<FramePair> revisiting_pairs(const std::vector<FrameMark>& marks, double distance_m,
                                        double turn_rad, double way_m, std::size_t most);

/// Frames that together make one full turn within `distance_m`, in steps of about `step_rad`; the last looks
/// the same way as the first to 20 degrees.
std::vector<std::vector<std::size_t>> full_turns(const std::vector<FrameMark>& marks, double step_rad,
                                                 double distance_m, std::size_t most);

/// Some scans of a log by their indices.
class ScanLibrary {
 public:
  void want(std::size_t index) { scans_[index]; }
  void want(const std::vector<std::size_t>& indices);
  void want(const std::vector<FramePair>& pairs);

  /// Reads the log once and keeps what is wanted.
  void fetch(const std::filesystem::path& path, const LogOptions& options);

  const LaserScan& at(std::size_t index) const { return scans_.at(index); }

 private:
  std::map<std::size_t, LaserScan> scans_;
};

}  // namespace psi_slam
