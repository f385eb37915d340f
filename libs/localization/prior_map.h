// SPDX-License-Identifier: BSD-3-Clause
// Aligns a mapped run with a prior map: a floor plan, or the map of an earlier run.
//
// A search of the whole map finds the first place, see GlobalSearch. From there, the scans of each further
// stretch of the path are matched near the place that the graph predicts, forwards and backwards along the
// path. Furniture that the prior map lacks is normal. So fewer points need to lie on walls than for a robot
// in a finished map, but most beams must cross no wall.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "localization/global_search.h"
#include "mapping/loop_closure/loop_consensus.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

struct PriorMapOptions {
  double sigma_m = 0.05;              ///< standard deviation of the walls of the prior map, > 0
  mrpt::math::TPoint2D offset{0, 0};  ///< see PlacedMapFile; places() adds it
  std::string source;                 ///< name of the prior map in messages
  LoopConsensusOptions consensus;
  std::uint64_t seed = 1;
};

/// Places of a run in a prior map.
struct PriorPlaces {
  std::vector<KnownPose> poses;  ///< in the order of the path; empty if the run does not fit
  std::string objection;         ///< why the run does not fit, a clause; empty if it does
  bool is_interrupted = false;   ///< the search was stopped; `poses` and `objection` are empty
  /// Number of places along the path in the space of the prior map; 0 if the run was not found there.
  std::size_t compared = 0;
  std::size_t fitting = 0;  ///< number of these places that fit
};

/// Pose of a node in a prior map.
struct PriorStart {
  std::size_t node = 0;
  mrpt::math::TPose2D prior_T_node;
};

class PriorMap {
 public:
  PriorMap(const mrpt::maps::COccupancyGridMap2D& map, PriorMapOptions options);

  /// Finds the places of a run. Deterministic. `start`, the pose of a node in the prior map, replaces
  /// the search of the whole map. `progress` gets the completed share of the work, in [0, 1]. If it returns
  /// false, the search stops. The mapper must not have landmarks in its graph.
  PriorPlaces places(const Mapper& mapper, const std::optional<PriorStart>& start = {},
                     const std::function<bool(double)>& progress = {}) const;

  /// Finds the place of a node in a window around a prediction. Empty if the scans do not fit there, and if
  /// the window is wide and another place fits as well.
  std::optional<MeasuredPose> place_near(std::size_t node, const KeyframeStore& keyframes,
                                         const mrpt::math::TPose2D& prior_T_predicted,
                                         const SearchExtent& window) const;

  /// Returns a pose in the prior map with the errors of its walls alone.
  MeasuredPose with_errors_of_walls(const mrpt::math::TPose2D& prior_T_robot) const;

  /// Searches the whole prior map for a node. Check FoundPlace::believed().
  FoundPlace place_anywhere(std::size_t node, const KeyframeStore& keyframes) const;

 private:
  struct Path;
  class Progress;
  std::string find(Path& path, Progress& progress) const;
  void follow(Path& path, Progress& progress) const;
  bool shows(std::size_t node, const KeyframeStore& keyframes,
             const mrpt::math::TPose2D& prior_T_robot) const;

  PriorMapOptions options_;
  GlobalSearch search_;
  CorrelativeMatcher matcher_;
};

}  // namespace psi_slam
