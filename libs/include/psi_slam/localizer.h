// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tracks a robot in a finished map, scan by scan. Finds the robot when it is lost: at the beginning, unless
/// its start is known, and after it was moved by hand.
///
///     auto localizer = Localizer::open("out/map.yaml", configuration);
///     LocalizationStep step = localizer.add(frame);
///
/// The front end measures the robot's motion without the map. While the robot is lost, its last scans are
/// matched with the whole map, by default after every metre of travel. The robot counts as found when several
/// searches from different places agree. From then on, each scan is matched in a small window around the
/// predicted pose. After too much time or travel without a fitting scan, the robot counts as lost again.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "psi_slam/frame.h"
#include "psi_slam/time_stamp.h"

namespace mrpt::maps {
class COccupancyGridMap2D;
}

namespace psi_slam {

struct LocalizerOptions;
struct ReferenceMap;

/// Best place found by a search of the whole map. Values that the search did not reach are 0.
struct FoundPlace {
  bool found = false;               ///< false: no place comes near the minimum response
  mrpt::math::TPose2D map_T_robot;  ///< robot pose in the map
  double response = 0;              ///< response of the scans at this pose, in [0, 1]
  double ambiguity = 0;             ///< response of the next best place, divided by `response`
  double observed_share = 0;        ///< share of the scans' points that lie in observed space of the map
  double agree = 0;                 ///< share of points in observed space that lie on or beside walls
  double clear_share = 0;           ///< share of the scans' beams that cross no wall of the map
  std::string objection;            ///< why the place was rejected, as a clause; empty if accepted
  bool ambiguous = false;           ///< true: rejected because another place fits equally well
  std::int64_t evaluations = 0;     ///< number of poses scored

  /// Returns whether a place was found and passed all checks.
  bool believed() const { return found && objection.empty(); }
};

/// Result of the localizer for one scan.
struct LocalizationStep {
  /// State of the localizer: whether the pose of the robot is known.
  enum class State { kLost, kTracking };
  TimeUs time_us = 0;               ///< time of the scan, microseconds
  State state = State::kLost;       ///< state after this scan
  mrpt::math::TPose2D map_T_robot;  ///< robot pose in the map; valid while tracking
  bool fits = false;      ///< whether the scan fits the map at this pose; false: the pose is a prediction
  double response = 0;    ///< response of the match, in [0, 1]; 0 if the scan does not fit
  double confidence = 0;  ///< share of the scan's points on the map's walls; 0 if the scan does not fit
  double moved_m = 0;     ///< distance moved since the previous scan
  std::optional<FoundPlace> search;  ///< search of the whole map, if this scan started one
};

/// Tracks a robot in a finished map, scan by scan, and finds it if it is lost.
class Localizer {
 public:
  /// Opens a map file: map.yaml with its image, or map.gridmap.gz. Pass a Configuration as `options`. Throws
  /// UserError if the file is unreadable or is not a map file, or if the map is rotated or has no wall.
  static Localizer open(const std::filesystem::path& map, const LocalizerOptions& options);

  /// Prepares a grid map, for example a result of draw_grid_map(). Pass a Configuration as `options`.
  Localizer(const mrpt::maps::COccupancyGridMap2D& map, const LocalizerOptions& options);
  /// Takes a prepared map, which several localizers can share.
  Localizer(ReferenceMap map, const LocalizerOptions& options);
  ~Localizer();
  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// Sets the approximate pose of the robot in the map: metres, radians. Call before the first scan or between
  /// scans.
  void start_at(const mrpt::math::TPose2D& map_T_robot);

  /// Localizes the robot at the next scan. Frames must come in the order of the log.
  LocalizationStep add(const Frame& frame);

 private:
  struct Members;
  std::unique_ptr<Members> m_;
};

}  // namespace psi_slam
