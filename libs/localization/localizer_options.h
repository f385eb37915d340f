// SPDX-License-Identifier: BSD-3-Clause
// Options of the localizer.
#pragma once

#include <cstdint>

#include "base/degrees.h"
#include "mapping/local_maps/front_end.h"
#include "mapping/loop_closure/loop_consensus.h"
#include "mapping/loop_closure/scan_context.h"
#include "matching/make_matcher.h"

namespace psi_slam {

/// Number of points of a scan context that keeps all its points.
constexpr int kAllPoints = 1'000'000;

/// Options of a search of the whole map.
struct GlobalSearchOptions {
  MatcherKind matcher = kLargeWindowMatcher;
  GeneticOptions genetic;  ///< options of csm_ga and ga
  MatcherOptions match;
  double resolution_m = 0.1;  ///< largest cell size of the coarse grid, which is searched first
  double smoothing_sigma_m = 0.03;
  ScanContextOptions context{15.0, 0.5, 0.2, kAllPoints};

  double min_response = 0.5;        ///< smallest response at the place found
  double max_ambiguity = 0.87;      ///< largest ratio of the next best place's response to the best response
  double min_observed_share = 0.5;  ///< smallest share of the scans' points in space that the map shows
  double min_agree = 0.75;          ///< smallest share of the points in mapped space that lie on walls
  /// Smallest share of the scans' beams that cross no wall of the map, if another place fits nearly as well
  /// (max_ambiguity).
  double min_clear_share = 0.9;
  /// The same share if the response of no other place reaches three quarters of the best response.
  double min_clear_share_alone = 0.6;
};

struct LocalizerOptions {
  FrontEndOptions front_end;  ///< options of the front end, which measures the motion
  GlobalSearchOptions search;
  LoopConsensusOptions consensus;
  std::uint64_t seed = 1;

  double search_travel_m = 1.0;  ///< while lost: path length per search of the whole map

  // Options while tracking.
  double window_m = 0.3;  ///< half-widths of the search window
  double window_rad = radians_from_degrees(6.0L);
  double prior_sigma_m = 0.05;  ///< standard deviations of the predicted pose
  double prior_sigma_rad = radians_from_degrees(2.0L);
  /// Half-widths of the search window from start_at() until a scan fits the map. The centre is the given
  /// start pose, moved by the front end's motion since then.
  double start_window_m = 1.0;
  double start_window_rad = radians_from_degrees(15.0L);
  double min_response = 0.3;
  double min_observed_share = 0.5;  ///< minimum share of a scan's points in observed space of the map
  double min_agree = 0.6;           ///< minimum share of the points in observed space that lie on walls
  double max_misfit_m = 2.0;        ///< the robot counts as lost after more travel without a fitting scan
  double max_misfit_s = 5.0;        ///< the robot counts as lost after more time without a fitting scan
};

}  // namespace psi_slam
