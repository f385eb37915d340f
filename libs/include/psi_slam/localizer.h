// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tracks a robot in a finished map, scan by scan. Finds the robot when it is lost: at the beginning, unless
/// its start is known, and after it was moved by hand.
///
///     auto localizer = Localizer::open("out/map.yaml", configuration);
///     LocalizationStep step = localizer.add(frame);
///
/// The front end measures the robot's motion in a frame of its own. While the robot is lost, its last scans
/// are searched for in the whole map after every metre of travel. The robot counts as found when several
/// searches from different places agree. From then on each scan is matched in a small window around the
/// predicted pose, until scans have not fitted for too long.
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

/// Result of a search of the whole map: its best place. The search stops at the first objection; what was
/// not examined is 0.
struct FoundPlace {
  bool found = false;               ///< false: no place comes near the least response
  mrpt::math::TPose2D map_T_robot;  ///< robot pose in the map
  double response = 0;              ///< response of the scans there, in [0, 1]
  double ambiguity = 0;             ///< response of the next best place, as a share of `response`
  double observed_share = 0;        ///< of the scans' points, in space that the map shows
  double agree = 0;                 ///< of the points in such space, on something occupied
  double clear_share = 0;           ///< of the scans' beams, through no wall of the map
  std::string objection;            ///< why the place is not believed, as a clause; empty if it is
  bool ambiguous = false;           ///< the objection is that another place fits as well
  std::int64_t evaluations = 0;     ///< poses scored

  /// Whether the place passed all checks.
  bool believed() const { return found && objection.empty(); }
};

/// Result of one scan.
struct LocalizationStep {
  /// Whether the pose of the robot is known.
  enum class State { kLost, kTracking };
  TimeUs time_us = 0;               ///< time of the scan, microseconds
  State state = State::kLost;       ///< state after this scan
  mrpt::math::TPose2D map_T_robot;  ///< valid while tracking
  bool fits = false;      ///< the scan fits the map there; false: the pose is only predicted by the motion
  double response = 0;    ///< of the match, if the scan fits
  double confidence = 0;  ///< share of the scan's points on the map's walls, if the scan fits
  double moved_m = 0;     ///< since the previous scan
  std::optional<FoundPlace> search;  ///< of the whole map, if this scan started one
};

/// Tracks a robot in a finished map, scan by scan, and finds it if it is lost.
class Localizer {
 public:
  /// Opens a map file: map.yaml with its image, or map.gridmap.gz. Pass a Configuration as `options`. Throws
  /// UserError if the file is unreadable, of another kind, rotated or without any wall.
  static Localizer open(const std::filesystem::path& map, const LocalizerOptions& options);

  /// Prepares a grid map, for example one of draw_grid_map(). Pass a Configuration as `options`.
  Localizer(const mrpt::maps::COccupancyGridMap2D& map, const LocalizerOptions& options);
  /// Takes a prepared map, which several localizers can share.
  Localizer(ReferenceMap map, const LocalizerOptions& options);
  ~Localizer();
  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// Tells where the robot starts, roughly. Call before the first scan.
  void start_at(const mrpt::math::TPose2D& map_T_robot);

  /// Processes the next scan.
  LocalizationStep add(const Frame& frame);

 private:
  struct Members;
  std::unique_ptr<Members> m_;
};

}  // namespace psi_slam
