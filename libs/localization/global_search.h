// SPDX-License-Identifier: BSD-3-Clause
// Finds a robot in a map without a start pose. The last scans, placed by the robot's own motion, are matched
// in a window that covers the whole map and all headings. A coarse grid is searched first, then the map's own
// cells near the best place. The place is accepted if its response is high enough, no other place fits as
// well, and the scans do not contradict the map. An exact search checks each place that a genetic search
// found and that would be accepted.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "localization/localizer_options.h"
#include "localization/reference_map.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "matching/make_matcher.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "psi_slam/localizer.h"

namespace psi_slam {

/// Number of beams of a scan, and of those that cross no wall of the map. At the true pose, few beams cross a
/// wall: only where the building has changed since it was mapped. The ends of the beams alone prove little,
/// because in a large building most ends lie near some wall.
struct ClearBeams {
  std::size_t beams = 0;  ///< number of all beams
  std::size_t clear = 0;  ///< number of beams that cross no wall before their end
  double share() const { return beams == 0 ? 0 : static_cast<double>(clear) / static_cast<double>(beams); }
};

/// Follows all beams of the scan through the map. A wall near the end of a beam counts as the surface that
/// the beam hit. A wall blocks a beam only if it continues on both sides of the beam for 0.1 m or two cells,
/// whichever is more, and only if the beam crosses it at 27 degrees or more.
ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot);

/// Half-width of the window in the fine grid around a match of the coarse grid, in coarse cells and heading
/// steps.
inline constexpr double kFineCells = 1.5;

/// A scan to match in a whole map, at all headings.
struct WholeMapProblem {
  const ScoreGrid& grid;
  const ScanPoints& scan;
  double min_response = 0;  ///< smallest response of a match, in [0, 1]
  double centre_rad = 0;    ///< heading at the centre of the window
  MatchSeed seed = {};
};

struct WholeMapMatch {
  MatchResult match;
  double centre_rad = 0;  ///< heading at the centre of the window in which the match was found
};

/// Matches a scan with a whole map and computes the ambiguity of the match. If the best heading is near the
/// ends of the window, both ends contain it, and the match seems ambiguous. The search is then repeated with
/// the opposite heading at the centre. `options` are those of `matcher`.
WholeMapMatch match_whole_map(const Matcher& matcher, const WholeMapProblem& problem,
                              const MatcherOptions& options);

class GlobalSearch {
 public:
  GlobalSearch(ReferenceMap map, const GlobalSearchOptions& options);

  /// Finds the pose of the robot at `node` from the scan of the node and the scans before it. If the
  /// best place is rejected, still returns it; FoundPlace::objection then says why it is rejected.
  FoundPlace find(std::size_t node, const KeyframeStore& memory, const MatchSeed& seed) const;

  const ReferenceMap& map() const { return map_; }

 private:
  FoundPlace judge(const MatchResult& somewhere, const ScanPoints& context, std::size_t node,
                   const KeyframeStore& memory) const;
  double least_clear_share(double ambiguity) const;
  std::string objection(FoundPlace& place, const ScanPoints& context, std::size_t node,
                        const KeyframeStore& memory) const;

  ReferenceMap map_;
  GlobalSearchOptions options_;
  std::unique_ptr<Matcher> matcher_;
  CorrelativeMatcher exact_matcher_;
  CorrelativeMatcher fine_matcher_;
};

}  // namespace psi_slam
