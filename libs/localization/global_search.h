// SPDX-License-Identifier: BSD-3-Clause
// Finds a robot in a map without any start pose. The robot's last scans, joined by its own motion, are
// matched in a window of the whole map and all headings: in large cells first, then in the map's own cells. A
// place is believed if no other place fits as well and if map and scans do not contradict each other.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "localization/localizer_options.h"
#include "localization/reference_map.h"
#include "loop_closure/keyframe_store.h"
#include "matching/make_matcher.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "psi_slam/localizer.h"

namespace psi_slam {

/// Beams of a scan, followed at a pose of a map. A scan taken there has no beam through a wall. It is not
/// enough that the ends of the beams lie on walls, since most ends find some wall in a large building.
struct ClearBeams {
  std::size_t beams = 0;
  std::size_t clear = 0;  ///< beams that meet no wall before their end
  double share() const { return beams == 0 ? 0 : static_cast<double>(clear) / static_cast<double>(beams); }
};

/// Follows all beams of the scan. A wall near the end of a beam counts as the surface that the beam hit.
ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot);

class GlobalSearch {
 public:
  GlobalSearch(ReferenceMap map, const GlobalSearchOptions& options);

  /// Finds the robot at `node` by its scan and the scans before it.
  FoundPlace find(std::size_t node, const KeyframeStore& memory, const MatchSeed& seed) const;

  const ReferenceMap& map() const { return map_; }

 private:
  MatchResult match_anywhere(const ScanPoints& context, const MatchSeed& seed) const;
  std::string objection(FoundPlace& place, const ScanPoints& context, std::size_t node,
                        const KeyframeStore& memory) const;

  ReferenceMap map_;
  GlobalSearchOptions options_;
  std::unique_ptr<Matcher> matcher_;
  CorrelativeMatcher fine_matcher_;
};

}  // namespace psi_slam
