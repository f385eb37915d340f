// SPDX-License-Identifier: BSD-3-Clause
// The figures of a run, computed once for the summary and the report.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {

/// What the exports cannot see in the result itself.
struct RunInfo {
  std::string program_version;                  ///< "0.1.0"
  std::string log_name;                         ///< as a person knows it: "intel.clf.gz"
  std::map<std::string, std::string> settings;  ///< "section.key" -> value, as text
  std::vector<std::string> warnings{};          ///< what was wrong with the log, a sentence each
};

/// The log as it was read.
struct MappedLogFacts {
  std::size_t scans = 0;
  std::size_t beams = 0;         ///< of the first scan
  double first_bearing_rad = 0;  ///< of the first scan
  double last_bearing_rad = 0;
  double max_range_m = 0;
  mrpt::math::TPose2D robot_T_laser;
  double returns = 0;               ///< share of all beams, of all lasers, that returned, in [0, 1]
  std::size_t companion_scans = 0;  ///< of lasers behind the first, that belong to its scans
  std::size_t spare_scans = 0;      ///< the same, that no frame took; what exports cannot see in the result
  TimeUs first_time_us = 0;
  TimeUs last_time_us = 0;
  double duration_s = 0;
  std::size_t stamps_back = 0;  ///< scans stamped earlier than the one before
  double odometry_length_m = 0;
};

/// How many loops were refused or switched off for one reason.
struct ReasonCount {
  LoopRefusal::Reason reason = LoopRefusal::Reason::kLowResponse;
  std::size_t count = 0;
};

struct LoopCounts {
  std::size_t tried = 0;  ///< windows searched, whether anything was found in them or not
  std::size_t found = 0;  ///< of those, with a match: each was accepted, refused, switched off or deleted
  std::size_t accepted = 0;
  std::size_t accepted_in_final_search = 0;
  std::size_t refused = 0;  ///< with those still pending when the run was stopped
  std::size_t switched_off = 0;
  std::size_t by_hand = 0;           ///< that a person deleted, forced or had matched
  std::vector<ReasonCount> reasons;  ///< of those refused or switched off, the most frequent first
};

/// What of the map was seen.
struct MapExtent {
  double x_min_m = 0;
  double y_min_m = 0;
  double x_max_m = 0;
  double y_max_m = 0;
  double resolution_m = 0;
  double asked_resolution_m = 0;
  double free_m2 = 0;
};

struct RunSummary {
  MappedLogFacts log;
  std::vector<FrameSpan> runs;  ///< that it was mapped in
  double path_length_m = 0;       ///< of the mapped trajectory
  std::size_t nodes = 0;
  std::size_t edges = 0;
  std::size_t local_maps = 0;
  LoopCounts loops;
  double mean_response = 0;      ///< over the frames that were matched
  std::int64_t evaluations = 0;  ///< poses scored, in the last pass too
  MapExtent map;
  double wall_s = 0;
  double real_time_factor = 0;  ///< seconds of the log in a second of work; 0 where that cannot be said
  double peak_memory_mib = 0;   ///< of this process so far
  bool interrupted = false;
  bool final_search_cut_short = false;
  std::optional<std::string> broken_off;  ///< what is wrong with the log behind its last scan
};

/// `grid` was drawn with the options `asked`.
RunSummary summarize_run(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                         const GridMapOptions& asked = {});

/// Where the map has coarser cells than asked for: a sentence without its full stop that says so and why.
std::optional<std::string> coarser_cells_text(const MapExtent& map);

/// The most that this process has ever held in memory.
double peak_memory_mib();

/// The length of a path, walked in steps of at least 0.1 m so that the jitter of a robot at rest does not add
/// up.
double path_length_m(const std::vector<mrpt::math::TPose2D>& poses);

}  // namespace psi_slam
