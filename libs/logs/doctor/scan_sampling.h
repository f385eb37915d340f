// SPDX-License-Identifier: BSD-3-Clause
// Selects scans of a log that are compared with each other. The selection uses odometry alone; a second pass
// over the log reads the selected scans.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

#include "base/degrees.h"
#include "base/share_observer.h"
#include "logs/doctor/log_facts.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Motion between two scans that are compared with odometry: the scans still overlap well.
inline constexpr double kComparedMotion_m = 0.25;
inline constexpr double kComparedTurn_rad = radians_from_degrees(12.0L);

/// Two frames by their indices, the earlier first.
struct FramePair {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// Returns `most` evenly spaced items, or all items if there are fewer.
template <class Item>
std::vector<Item> thinned(const std::vector<Item>& items, std::size_t most) {
  if (items.size() <= most) return items;
  std::vector<Item> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(items[i * items.size() / most]);
  return kept;
}

/// Returns the pose at `second` relative to `first`, by odometry.
mrpt::math::TPose2D odometry_between(const std::vector<FrameMark>& marks, const FramePair& pair);

/// Returns the sum of turns by odometry from frame 0 to each frame, radians, not wrapped.
std::vector<double> unwrapped_headings(const std::vector<FrameMark>& marks);

/// Returns up to `count` frames, spread evenly over all motion by odometry. The unit of length of odometry
/// does not matter. If odometry never moves, the frames are spread evenly over the log.
std::vector<std::size_t> frames_in_motion(const std::vector<FrameMark>& marks, std::size_t count);

/// Returns pairs of frames that are at least `distance_m` or `turn_rad` apart; each pair begins where the
/// pair before it ends. Selects `most` of them evenly if there are more.
std::vector<FramePair> pairs_by_motion(const std::vector<FrameMark>& marks, double distance_m,
                                       double turn_rad, std::size_t most);

/// Like pairs_by_motion(), but a pair begins after each fifth of such a motion, so that pairs overlap.
std::vector<FramePair> overlapping_pairs(const std::vector<FrameMark>& marks, double distance_m,
                                         double turn_rad, std::size_t most);

/// Returns pairs of frames between which the robot turns by `min_turn_rad` to `max_turn_rad` and moves at
/// most `distance_m`. Selects `most` of them evenly if there are more.
std::vector<FramePair> pairs_by_turn(const std::vector<FrameMark>& marks, double min_turn_rad,
                                     double max_turn_rad, double distance_m, std::size_t most);

/// Returns pairs of frames whose poses by odometry are within `distance_m` and `turn_rad`, after a path of at
/// least `way_m`. Selects `most` of them evenly if there are more.
std::vector<FramePair> revisiting_pairs(const std::vector<FrameMark>& marks, double distance_m,
                                        double turn_rad, double way_m, std::size_t most);

/// Returns the first `most` sequences of frames that make one full turn within `distance_m`, in steps of
/// about `step_rad`. The first and last headings differ by at most 20 degrees.
std::vector<std::vector<std::size_t>> full_turns(const std::vector<FrameMark>& marks, double step_rad,
                                                 double distance_m, std::size_t most);

/// Returns whether two scans span about the same angle. If a laser changes the number of its beams but states
/// one angle between them, the bearings of some scans are wrong, and alignments turn by as much.
bool have_same_span(const LaserScan& a, const LaserScan& b);

/// Selected scans of a log, by the index of their frame.
class ScanLibrary {
 public:
  void want(std::size_t index) { scans_[index]; }
  void want(const std::vector<std::size_t>& indices);
  void want(const std::vector<FramePair>& pairs);

  /// Reads the log once and keeps the wanted scans.
  void fetch(const std::filesystem::path& path, const LogOptions& options,
             const ShareObserver& progress = {});

  /// Takes all scans of a log and keeps the wanted ones. Replaces fetch() if the scans are in memory.
  void take(const std::vector<const LaserScan*>& scans);

  /// Replaces the mount of all scans.
  void set_mount(const mrpt::math::TPose2D& robot_T_laser) {
    for (auto& [index, scan] : scans_) scan.robot_T_laser = robot_T_laser;
  }

  const LaserScan& at(std::size_t index) const { return scans_.at(index); }

 private:
  std::map<std::size_t, LaserScan> scans_;
};

}  // namespace psi_slam
