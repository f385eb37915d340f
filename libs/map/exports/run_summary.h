// SPDX-License-Identifier: BSD-3-Clause
// The figures of a run, computed once for summary.json, the report and the closing message.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "map/exports/unmatched_scans.h"
#include "map/rendering/map_drawing.h"
#include "map/verdict/map_verdict.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Value of an option that log.calibrate has estimated from a log.
struct CalibratedOption {
  std::string log;     ///< name of the log
  std::string laser;   ///< name of the laser that the estimate is for; empty: all lasers
  std::string option;  ///< name of the option, which states the unit: "log.scan_delay_s"
  double value = 0;
  double deviation = 0;   ///< standard deviation
  bool is_used = false;   ///< false: not determined well enough, or not needed
  bool is_fault = false;  ///< replaces a wrong statement of the log, also without log.calibrate
};

/// Inputs and circumstances of a run: versions, settings, warnings and the like.
struct RunInfo {
  std::string program_version;                  ///< version of the program: "0.1.0"
  std::string log_name;                         ///< name of the log for display: "intel.clf.gz"
  std::map<std::string, std::string> settings;  ///< value of each option by its name "section.key"
  std::vector<std::string> warnings{};          ///< warnings about log and map, a sentence each
  std::vector<CalibratedOption>
      calibration{};  ///< estimates of log.calibrate, and what replaces wrong statements
};

/// The log as it was read. Beams, bearings, maximum range and mount are those of the first scan.
struct MappedLogFacts {
  std::size_t scans = 0;
  std::size_t beams = 0;
  double first_bearing_rad = 0;
  double last_bearing_rad = 0;
  double max_range_m = 0;
  mrpt::math::TPose2D robot_T_laser;
  double returns = 0;               ///< share of beams with a return, over all lasers, in [0, 1]
  std::size_t companion_scans = 0;  ///< scans of further lasers that are part of a frame
  std::size_t spare_scans = 0;      ///< scans of further lasers in no frame; set by the caller
  TimeUs first_time_us = 0;
  TimeUs last_time_us = 0;
  double duration_s = 0;        ///< sum of the durations of all runs
  std::size_t stamps_back = 0;  ///< scans with an earlier time than the previous scan of their run
  double odometry_length_m = 0;
};

/// Number of loops rejected for one reason.
struct ReasonCount {
  LoopRejection::Reason reason = LoopRejection::Reason::kLowResponse;
  std::size_t count = 0;
};

struct LoopCounts {
  std::size_t tried = 0;     ///< search windows tried, with or without a match
  std::size_t found = 0;     ///< search windows in which a match was found
  std::size_t accepted = 0;  ///< matches that were accepted
  std::size_t accepted_in_final_search = 0;
  /// Matches that were rejected, including those still candidates when the run was stopped.
  std::size_t rejected = 0;
  std::size_t by_hand = 0;           ///< loops that a person deleted, forced or matched again
  std::vector<ReasonCount> reasons;  ///< reasons of rejected matches, the most frequent first
};

/// Extent of the observed part of the map.
struct MapExtent : MapRectangle {
  double resolution_m = 0;
  double asked_resolution_m = 0;  ///< side of a cell that the settings ask for
  double free_m2 = 0;             ///< area of free space
  /// Pose of the mapper's frame, in which the robot starts at 0, in the map; set by the caller.
  mrpt::math::TPose2D map_T_start{};
};

/// How a run fits its prior map.
struct PriorFit {
  bool is_accepted = false;  ///< the map of the run is aligned with the prior map
  /// Places along the path in the space of the prior map; 0 if the run was not found there.
  std::size_t places = 0;
  std::size_t fitting = 0;   ///< part of `places` that fit
  bool is_extended = false;  ///< the exported map is the prior map, brought up to date
};

struct RunSummary {
  MappedLogFacts log;
  std::vector<FrameSpan> runs;  ///< all runs in the result; more than one if runs were merged
  double path_length_m = 0;     ///< length of the mapped trajectory
  std::size_t nodes = 0;
  std::size_t edges = 0;
  std::size_t local_maps = 0;
  LoopCounts loops;
  UnmatchedScans unmatched;
  std::optional<MapVerdict> verdict;  ///< set by the caller; empty: the map was not judged
  std::optional<PriorFit> prior;      ///< set by the caller; empty: no prior map
  double mean_response = 0;           ///< mean response of the matched frames
  std::int64_t evaluations = 0;       ///< number of poses scored, including the final search
  MapExtent map;
  double wall_s = 0;
  double real_time_factor = 0;  ///< seconds of the log per second of work; 0 if unknown
  double peak_memory_mib = 0;   ///< largest memory of this process so far
  bool interrupted = false;
  bool final_search_cut_short = false;
  std::optional<std::string> broken_off;  ///< damage of the log after its last readable scan
};

/// Computes the figures. `grid` is the map of `result`, drawn with the options `asked`.
RunSummary summarize_run(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                         const GridMapOptions& asked = {});

inline constexpr int kSummarySchemaVersion = 2;

/// Returns summary.json: the figures for programs, with units in the keys. "schema" is "psi-slam-summary";
/// "schema_version" increases when a key is renamed or removed, not when one is added. Figures that are not
/// finite become null, bytes that are not UTF-8 are replaced.
std::string summary_json(const MappingResult& result, const RunInfo& info, const RunSummary& summary);

/// Returns a warning, a sentence without full stop, if the cells of the map are larger than asked for. Empty
/// otherwise.
std::optional<std::string> coarser_cells_text(const MapExtent& map);

/// Returns the largest memory of this process so far, in MiB.
double peak_memory_mib();

/// Returns the length of a path, metres. Measures in steps of at least 0.1 m, so that the jitter of a robot
/// at rest does not add up.
double path_length_m(const std::vector<mrpt::math::TPose2D>& poses);

}  // namespace psi_slam
