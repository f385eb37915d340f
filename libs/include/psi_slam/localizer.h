// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Localizes a robot in a finished map.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "psi_slam/frame.h"

namespace psi_slam {

struct LocalizerOptions;
struct ReferenceMap;

/// Reads a map that psi-slam or another program wrote: `map.yaml` with the image that it names, or
/// `map.gridmap.gz`. The extension decides. Throws UserError if the file is unreadable, of another kind,
/// rotated or without any wall.
mrpt::maps::COccupancyGridMap2D read_map_file(const std::filesystem::path& path);

/// Best place of a search of the whole map. Figures of checks that were not reached are 0.
struct FoundPlace {
  bool found = false;               ///< false: no place of the map comes near the least response
  mrpt::math::TPose2D map_T_robot;  ///< robot pose in the map
  double response = 0;              ///< response of the scans there, in [0, 1]
  double ambiguity = 0;             ///< response of the next best place over `response`, in [0, 1]
  double observed_share = 0;        ///< fraction of the scans' points in space that the map has observed
  double agree = 0;                 ///< fraction of these points on occupied cells
  double clear_share = 0;           ///< fraction of the beams that cross no wall of the map
  std::string objection;            ///< reason to reject the place, as a clause; empty: accepted
  bool ambiguous = false;           ///< the objection is that another place fits as well
  std::int64_t evaluations = 0;     ///< poses scored by the search

  /// Whether the place passed all checks.
  bool believed() const { return found && objection.empty(); }
};

/// Result of Localizer::add() for one scan.
struct LocalizationStep {
  /// Whether the pose of the robot is known.
  enum class State {
    kLost,      ///< unknown
    kTracking,  ///< known: see map_T_robot
  };
  TimeUs time_us = 0;                ///< time of the scan, microseconds
  State state = State::kLost;        ///< state after this scan
  mrpt::math::TPose2D map_T_robot;   ///< robot pose in the map; valid while tracking
  bool fits = false;                 ///< the scan fits the map; false: the pose follows the motion alone
  double response = 0;               ///< response of the scan in [0, 1], if it fits
  double confidence = 0;             ///< fraction of its points on walls of the map, if it fits
  double moved_m = 0;                ///< travel since the previous scan, metres
  std::optional<FoundPlace> search;  ///< search of the whole map, if this scan started one
};

/// Tracks a robot in a finished map, scan by scan.
///
/// The front end measures the motion in a frame of its own. While the robot is lost, the last scans are
/// searched for in the whole map after every metre. The robot is found when several searches from different
/// places agree. From then on, each scan is matched in a small window around the predicted pose. The robot is
/// lost again when the scans have not fitted for some travel or time, for example because it was carried
/// away.
class Localizer {
 public:
  /// Prepares `map` for searches. Pass a Configuration as `options`.
  Localizer(const mrpt::maps::COccupancyGridMap2D& map, const LocalizerOptions& options);
  /// Uses a prepared map, which several localizers can share.
  Localizer(const ReferenceMap& map, const LocalizerOptions& options);
  ~Localizer();
  /// Moves the localizer; the moved-from one can only be destroyed.
  Localizer(Localizer&&) noexcept;
  /// Moves the localizer; the moved-from one can only be destroyed.
  Localizer& operator=(Localizer&&) noexcept;

  /// Tells that the robot starts near this pose. Call it before the first scan. Without it, the robot starts
  /// lost.
  void start_at(const mrpt::math::TPose2D& map_T_robot);

  /// Localizes the next scan. Scans have the order of time.
  LocalizationStep add(const Frame& frame);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
