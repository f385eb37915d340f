// SPDX-License-Identifier: BSD-3-Clause
// The map that CMetricMapBuilderPsi::initialize() was given, and the robot in it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <vector>

#include "localization/place_consensus.h"
#include "localization/prior_map.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/log_options.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

class InitialMap {
 public:
  /// Draws the 2D range scans of a map. Throws UserError if it has none, or an invalid one.
  InitialMap(const mrpt::maps::CSimpleMap& map, const LogOptions& log, const GridMapOptions& options,
             const LoopConsensusOptions& consensus);

  /// States the approximate pose of the robot at its first scan, so that the search covers only its
  /// surroundings.
  void start_at(const mrpt::math::TPose2D& initial_T_start) { initial_T_run_ = {initial_T_start, 0.1, 0.1}; }

  /// Looks for the newest node in the map. Returns the pose of the mapper's frame in the map if this node
  /// gives a new one.
  std::optional<MeasuredPose> follow(const Mapper& mapper);

  /// Whether the robot's place in the map was found, or stated.
  bool is_found() const { return initial_T_run_.has_value(); }

  /// Finds the places of the whole run. PriorPlaces::objection is empty if the run fits the map.
  PriorPlaces places(const Mapper& mapper) const;

  const mrpt::maps::COccupancyGridMap2D& grid() const { return grid_; }
  const mrpt::maps::CSimpleMap& frames() const { return frames_; }

 private:
  mrpt::maps::CSimpleMap frames_;
  mrpt::maps::COccupancyGridMap2D grid_;
  PriorMap map_;
  PlaceConsensus consensus_;
  std::optional<MeasuredPose> initial_T_run_;
  std::optional<PriorStart> start_;   ///< last node that was found
  std::optional<double> searched_m_;  ///< path length at the last search
};

}  // namespace psi_slam
