// SPDX-License-Identifier: BSD-3-Clause
// Where in a map a robot is, of which nothing is known: its last scans, joined by its own motion, are matched
// in a window that holds the whole map and all headings, in large cells first, then in the map's own. A place
// is believed when it is unlike all others of the map, and when map and scans do not contradict each other,
// looked at from either side.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <memory>
#include <string>

#include "localization/reference_map.h"
#include "loop_closure/keyframe_store.h"
#include "loop_closure/scan_context.h"
#include "matching/make_matcher.h"

namespace psi_slam {

struct GlobalSearchOptions {
  MatcherKind matcher = MatcherKind::kCsm;  ///< that searches the whole map
  GeneticOptions genetic;                   ///< of csm_ga and ga
  MatcherOptions match;
  double resolution_m = 0.1;  ///< of the grid that is searched
  double smoothing_sigma_m = 0.03;
  ScanContextOptions context{15.0, 0.5, 0.2};

  double min_response = 0.5;        ///< of the scans at the place found
  double max_ambiguity = 0.87;      ///< response of the next best place of the map, as a share of the best
  double min_observed_share = 0.5;  ///< of the scans' points, in space that the map shows
  double min_agree = 0.75;          ///< of the scans' points in observed space, on something occupied
  double min_clear_share = 0.9;     ///< of the scans' beams, that go through no wall of the map
};

/// The best place of the map; what was not looked at any more is 0.
struct FoundPlace {
  bool found = false;  ///< false: no place of the map comes near min_response
  mrpt::math::TPose2D map_T_robot;
  double response = 0;
  double ambiguity = 0;
  double observed_share = 0;
  double agree = 0;
  double clear_share = 0;
  std::string objection;   ///< why it is not to be believed, as a clause; empty: it is
  bool ambiguous = false;  ///< the objection is that another place fits as well
  std::int64_t evaluations = 0;

  bool believed() const { return found && objection.empty(); }
};

class GlobalSearch {
 public:
  GlobalSearch(ReferenceMap map, const GlobalSearchOptions& options);

  /// The place of the robot at `node`, by its scan and those on the way there.
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
