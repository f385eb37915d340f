// SPDX-License-Identifier: BSD-3-Clause
#include "exports/run_summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "rendering/map_image.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Its stamps, its time and its way: drives may overlap in time, and lie anywhere for all that odometry says.
void add_run(const std::vector<Frame>& log, const FrameSpan& drive, MappedLogFacts& facts) {
  TimeUs first_us = log[drive.begin].time_us;
  TimeUs last_us = first_us;
  TimeUs previous_us = first_us;
  std::vector<TPose2D> odometry;
  for (std::size_t i = drive.begin; i < drive.end; ++i) {
    const TimeUs time_us = log[i].time_us;
    first_us = std::min(first_us, time_us);
    last_us = std::max(last_us, time_us);
    facts.stamps_back += time_us < previous_us ? 1 : 0;
    previous_us = time_us;
    odometry.push_back(log[i].odom_T_robot);
  }
  facts.first_time_us = std::min(facts.first_time_us, first_us);
  facts.last_time_us = std::max(facts.last_time_us, last_us);
  facts.duration_s += seconds(last_us - first_us);
  facts.odometry_length_m += path_length_m(odometry);
}

MappedLogFacts log_facts(const MappingResult& result) {
  MappedLogFacts facts;
  facts.scans = result.log.size();
  if (result.log.empty()) return facts;
  const LaserScan& first = result.log.front().scan;
  facts.beams = first.ranges_m.size();
  if (first.bearings_rad && !first.bearings_rad->empty()) {
    facts.first_bearing_rad = static_cast<double>(first.bearings_rad->front());
    facts.last_bearing_rad = static_cast<double>(first.bearings_rad->back());
  }
  facts.max_range_m = static_cast<double>(first.max_range_m);
  facts.robot_T_laser = first.robot_T_laser;
  facts.first_time_us = facts.last_time_us = result.log.front().time_us;
  std::size_t beams = 0;
  std::size_t returns = 0;
  for (const Frame& frame : result.log) {
    facts.companion_scans += frame.companions.size();
    for_each_scan(frame, {}, [&](const LaserScan& scan, const TPose2D&) {
      beams += scan.ranges_m.size();
      for (const float range_m : scan.ranges_m) returns += std::isfinite(range_m) ? 1 : 0;
    });
  }
  facts.returns = beams == 0 ? 0 : static_cast<double>(returns) / static_cast<double>(beams);
  for (const FrameSpan& drive : runs_of(result)) add_run(result.log, drive, facts);
  return facts;
}

LoopCounts loop_counts(const MappingResult& result) {
  LoopCounts counts;
  for (const auto& [kind, matcher] : result.loop_matchers) {
    counts.tried += matcher.effort.attempts;
    counts.found += matcher.effort.found;
  }
  std::map<LoopRefusal::Reason, std::size_t> reasons;
  for (const LoopRecord& loop : result.loops) {
    counts.by_hand += loop.by_hand ? 1 : 0;
    if (loop.verdict == LoopVerdict::kNotFound) continue;
    if (loop.verdict == LoopVerdict::kAccepted) {
      ++counts.accepted;
      counts.accepted_in_final_search += loop.in_final_search ? 1 : 0;
      continue;
    }
    if (loop.verdict == LoopVerdict::kDeleted) continue;
    ++(loop.verdict == LoopVerdict::kSwitchedOff ? counts.switched_off : counts.refused);
    if (loop.refusal) ++reasons[loop.refusal->reason];
  }
  for (const auto& [reason, count] : reasons) counts.reasons.push_back({reason, count});
  std::stable_sort(counts.reasons.begin(), counts.reasons.end(),
                   [](const ReasonCount& a, const ReasonCount& b) { return a.count > b.count; });
  return counts;
}

MapExtent map_extent(const mrpt::maps::COccupancyGridMap2D& grid) {
  const SeenCells seen = seen_cells(grid);
  const auto cell_m = static_cast<double>(grid.getResolution());
  const auto x_min = static_cast<double>(grid.getXMin());
  const auto y_min = static_cast<double>(grid.getYMin());
  MapExtent extent;
  extent.x_min_m = x_min + seen.x_begin * cell_m;
  extent.x_max_m = x_min + seen.x_end * cell_m;
  extent.y_min_m = y_min + seen.y_begin * cell_m;
  extent.y_max_m = y_min + seen.y_end * cell_m;
  extent.resolution_m = cell_m;
  extent.free_m2 = static_cast<double>(seen.free) * cell_m * cell_m;
  return extent;
}

}  // namespace

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts kibibytes
}

double path_length_m(const std::vector<TPose2D>& poses) {
  constexpr double kStep_m = 0.1;
  if (poses.empty()) return 0;
  double length = 0;
  TPose2D from = poses.front();
  const auto distance = [&](const TPose2D& to) { return std::hypot(to.x - from.x, to.y - from.y); };
  for (const TPose2D& pose : poses) {
    if (distance(pose) < kStep_m) continue;
    length += distance(pose);
    from = pose;
  }
  return length + distance(poses.back());
}

RunSummary summarize_run(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                         const GridMapOptions& asked) {
  RunSummary summary;
  summary.log = log_facts(result);
  summary.runs = runs_of(result);
  std::size_t matched = 0;
  for (const FrameRecord& frame : result.frames) {
    summary.evaluations += frame.evaluations;
    summary.mean_response += frame.response;
    matched += frame.response > 0 ? 1 : 0;
  }
  for (const auto& [kind, matcher] : result.loop_matchers)
    summary.evaluations += matcher.final_search_effort.evaluations;
  if (matched > 0) summary.mean_response /= static_cast<double>(matched);
  for (const FrameSpan& drive : summary.runs) {
    std::vector<TPose2D> poses;
    for (std::size_t i = drive.begin; i < drive.end; ++i) poses.push_back(result.frames[i].map_T_robot);
    summary.path_length_m += path_length_m(poses);
  }
  summary.nodes = result.graph.num_nodes();
  summary.edges = result.graph.num_enabled_constraints();
  summary.local_maps = result.local_maps.size();
  summary.loops = loop_counts(result);
  summary.map = map_extent(grid);
  summary.map.asked_resolution_m = asked.resolution_m;
  summary.wall_s = result.wall_s;
  if (result.wall_s > 0) summary.real_time_factor = summary.log.duration_s / result.wall_s;
  summary.peak_memory_mib = peak_memory_mib();
  summary.interrupted = result.interrupted;
  summary.final_search_cut_short = result.final_search_cut_short;
  summary.broken_off = result.broken_off;
  return summary;
}

std::optional<std::string> coarser_cells_text(const MapExtent& map) {
  if (map.resolution_m < 1.5 * map.asked_resolution_m) return std::nullopt;  // it is doubled at least
  const auto metres = [](double value) { return shortest_text(static_cast<float>(value)) + " m"; };
  return "map.max_cells leaves no room for cells of " + metres(map.asked_resolution_m) +
         ": those of the map are " + metres(map.resolution_m);
}

}  // namespace psi_slam
