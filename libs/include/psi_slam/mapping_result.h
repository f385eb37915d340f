// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The result of a mapping run: plain values that exports, reports and views read.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/matching.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Whether the front end matched a scan with a local map.
enum class ScanMatch {
  kNoMap,      ///< there was nothing to match with: the first scan of a run
  kMatched,    ///< the match gives the pose
  kUnmatched,  ///< odometry, or constant velocity without odometry, gives the pose
};

/// What happened to one scan of the log.
struct FrameRecord {
  TimeUs time_us = 0;  ///< time of the scan, microseconds
  /// Raw odometry; without odometry the front end's pose. Odometry of a later run continues from the place in
  /// the map where that run begins.
  mrpt::math::TPose2D odom_T_robot;
  mrpt::math::TPose2D front_end_T_robot;  ///< the front end's pose, without loop closing
  /// The result. finish() refines it with the scans nearby, see refine_jointly().
  mrpt::math::TPose2D map_T_robot;
  std::optional<std::size_t> node;  ///< its node in the graph, if it became one

  ScanMatch match = ScanMatch::kNoMap;  ///< whether the scan was matched with a local map

  double response = 0;    ///< of the front end's match, in [0, 1]; 0 if it was not matched
  SearchExtent window;    ///< the front end's search window (half-widths)
  double psi = 0;         ///< equation 13, before the loops of this frame
  double eta = 0;         ///< equation 14
  double mean_loops = 0;  ///< the mean of C_i in equation 13
  int loops_tried = 0;    ///< local maps matched with this frame to close a loop
  /// C_i of equation 13: loops that became constraints at this frame, found here or confirmed here. Loops
  /// that are switched off later count too.
  int loops_accepted = 0;
  std::optional<MatcherKind> matcher;  ///< that searches for loops at this frame; none at other frames
  std::int64_t loop_evaluations = 0;   ///< poses scored to close loops
  std::int64_t evaluations = 0;        ///< poses scored by loop closing and the front end

  double front_end_ms = 0;      ///< matching and insertion into the local maps
  double loop_matching_ms = 0;  ///< sum over the matches, which may run at the same time
  double loop_closing_ms = 0;   ///< wall time, candidates and verification included
  double pose_graph_ms = 0;     ///< optimisation of the graph
};

/// What one matcher did to close loops, over the whole run.
struct LoopMatcherRecord {
  LoopEffort effort;                         ///< cost of all its searches
  LoopEffort final_search_effort;            ///< part of `effort` spent in the final search
  std::size_t accepted = 0;                  ///< constraints in the finished graph
  std::size_t accepted_in_final_search = 0;  ///< part of `accepted` found in the final search
};

/// One local map: its anchor node and the nodes whose scans it holds, [first_node, last_node].
struct LocalMapRecord {
  std::size_t anchor = 0;      ///< node that carries the frame of the local map
  std::size_t first_node = 0;  ///< first node whose scan it holds
  std::size_t last_node = 0;   ///< last node whose scan it holds
};

/// Time spent in one stage of the work, over all its calls.
struct StageTiming {
  std::string name;       ///< for people: "match scan to local map"
  std::size_t calls = 0;  ///< number of calls
  double mean_ms = 0;     ///< mean time of a call
  double std_ms = 0;      ///< standard deviation of the time of a call
  double min_ms = 0;      ///< shortest call
  double max_ms = 0;      ///< longest call
  double total_s = 0;     ///< sum over all calls
};

/// Thresholds of the factor Psi, see PsiOptions.
struct PsiThresholds {
  double psi_1 = 0;  ///< up to this Psi, loops are searched exhaustively
  double psi_2 = 0;  ///< from this Psi on, loops are searched genetically
};

/// A finished map: scans, poses, graph and loops, and how they came about.
struct MappingResult {
  std::vector<Frame> log;           ///< the scans themselves, same order and count as `frames`
  std::vector<FrameRecord> frames;  ///< one record for each scan, with its pose in the map
  /// Optimised, then refined with the scans. Optimising the graph again undoes that refinement.
  PoseGraph graph;
  std::vector<std::size_t> node_frames;       ///< the frame of each node
  std::vector<std::size_t> later_run_frames;  ///< the first frame of each run after the first
  std::vector<LocalMapRecord> local_maps;     ///< all local maps, in the order of their beginnings
  std::vector<LoopRecord> loops;              ///< all attempts to close loops that found a match
  std::vector<std::string> unmet_edits;       ///< edits that could not be made, a sentence each
  PsiThresholds psi;                          ///< thresholds that chose the matchers
  std::map<MatcherKind, LoopMatcherRecord> loop_matchers;  ///< of the matchers that were used
  std::vector<StageTiming> stages;                         ///< times of the stages of the work
  double wall_s = 0;                                       ///< of the whole run so far, loading included
  bool interrupted = false;               ///< stopped before the log's end, or final search cut short
  bool final_search_cut_short = false;    ///< pairs were left untried, or scans unrefined
  std::optional<std::string> broken_off;  ///< what is wrong with the log after its last scan, as a sentence
};

/// Consecutive frames, [begin, end).
struct FrameSpan {
  std::size_t begin = 0;  ///< first frame
  std::size_t end = 0;    ///< frame after the last
};

/// The frames of each run: one span unless several runs were merged.
std::vector<FrameSpan> runs_of(const MappingResult& result);
/// The frames of each run among the first `frames`. `later_run_frames` is as in MappingResult.
std::vector<FrameSpan> runs_of(std::size_t frames, const std::vector<std::size_t>& later_run_frames);

/// The number of the first run that no chain of loops joins to run 0; none if all are joined.
std::optional<std::size_t> unjoined_run(const MappingResult& result);

}  // namespace psi_slam
