// SPDX-License-Identifier: BSD-3-Clause
// Cases for the matchers, drawn from a mapped log. Each case has a scan, a finished local map of another
// time, and a start pose. The start pose is as inaccurate as the predicted pose of a loop may be.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "common/benchmark_logs.h"
#include "mapping/local_maps/local_map.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "matching/matcher.h"

namespace psi_slam {

/// A mapped log: the nodes and local maps that loops join, and the optimised poses, which serve as truth.
struct MappedLog {
  std::string name;
  MapperOptions options;
  KeyframeStore memory;                         ///< all nodes and local maps of the log
  std::vector<mrpt::math::TPose2D> map_T_node;  ///< optimised poses of the nodes
  double translation_error_m = 0;               ///< mean over the relations
};

/// Maps a log with relations. Calls `progress` with the share of the log that is read. Throws UserError as
/// open_log() and read_relations().
MappedLog map_log(const BenchmarkLog& log, const std::function<void(double)>& progress);

struct CaseOptions {
  double window_m = 8;  ///< half-width of the search window
  double window_rad = radians_from_degrees(30.0L);
  bool context = false;     ///< match the scan together with earlier ones, see scan_context.h
  std::size_t count = 250;  ///< number of positive cases, and of negative ones
  std::uint64_t seed = 1;

  double min_travel_m = 10;  ///< least path length between node and local map: closer pairs may share scans
  double near_m = 1.5;       ///< positive: largest distance from the node to a node of the local map
  double clear_m = 20;       ///< negative: least distance from node to local map nodes, minus window_m
  double min_observed_share = 0.7;  ///< positive: least share of points in observed space of the local map
  double min_hit_share = 0.8;       ///< positive: least share of these points on or beside occupied cells
  double start_share = 0.75;        ///< radius of the disc of start poses, as a share of window_m
  double turn_share = 25.0 / 30;    ///< largest rotation of start poses, as a share of window_rad
  std::size_t min_points = 30;      ///< scans with fewer points are not used
};

struct LoopCase {
  bool positive = false;      ///< the scan was taken in the local map; otherwise far away from it
  std::size_t node = 0;       ///< node of the scan
  std::size_t local_map = 0;  ///< index in KeyframeStore::local_maps
  std::shared_ptr<const ScanPoints> scan;
  std::shared_ptr<const LocalMap> map;
  mrpt::math::TPose2D anchor_T_node;  ///< true pose of the node; outside the window in negative cases
  mrpt::math::TPose2D start;          ///< centre of the window, in the frame of the local map
  MatchSeed seed;
};

/// Draws `options.count` positive cases, then as many negative ones, or fewer if the log has no more. No pair
/// of scan and local map occurs twice. The same log, options and seed give the same cases.
std::vector<LoopCase> draw_cases(const MappedLog& log, const CaseOptions& options);

}  // namespace psi_slam
