// SPDX-License-Identifier: BSD-3-Clause
// Loops to be found, drawn from a mapped log: a scan, a finished local map that the robot filled at another
// time, and a start pose as far off the truth as a loop closer's prediction may be.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "base/degrees.h"
#include "local_maps/local_map.h"
#include "matching/matcher.h"

namespace psi_slam {

struct CaseOptions {
  double window_m = 8;  ///< half-width of the search
  double window_rad = radians_from_degrees(30.0L);
  bool context = false;     ///< the scan with what was seen on the way to it, as loops in wide windows search
  std::size_t count = 250;  ///< of each kind
  std::uint64_t seed = 1;

  double min_travel_m = 10;  ///< of the path, between the node and the local map: nearer ones share scans
  double near_m = 1.5;       ///< positive: a node of the local map is at most this far from the case's node
  double clear_m = 20;  ///< negative: no node of the local map is within the window's half-width and this
  double min_observed_share = 0.7;  ///< positive: of the points, in space that the local map observed,
  double min_hit_share = 0.8;       ///< and of those, on something occupied
  double start_share = 0.75;        ///< start poses lie in a disc of this share of window_m,
  double turn_share = 25.0 / 30;    ///< and are turned by up to this share of window_rad
  std::size_t min_points = 30;      ///< scans with fewer are blind
};

struct LoopCase {
  bool positive = false;      ///< the scan was taken in the local map; else far from it
  std::size_t node = 0;       ///< whose scan it is
  std::size_t local_map = 0;  ///< index in KeyframeStore::local_maps
  std::shared_ptr<const ScanPoints> scan;
  std::shared_ptr<const LocalMap> map;
  mrpt::math::TPose2D anchor_T_node;  ///< the truth, of negatives too: there it lies outside the window
  mrpt::math::TPose2D start;          ///< the centre of the window
  MatchSeed seed;
  std::string adaptive_matcher;  ///< that the adaptive one uses here
};

/// Up to `count` positive cases, then as many negative ones, fewer where the log has no more. No pair of scan
/// and local map comes twice. The same log, options and seed give the same cases.
std::vector<LoopCase> draw_cases(const MappedLog& log, const CaseOptions& options);

}  // namespace psi_slam
