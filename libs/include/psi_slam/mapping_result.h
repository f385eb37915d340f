// SPDX-License-Identifier: BSD-3-Clause
// What a mapping run leaves behind: plain values that the exports, the report and the views read.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "loop_closure/loop_closure_factor.h"
#include "psi_slam/loop_record.h"
#include "mapping/stage_clock.h"
#include "matching/search_window.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// What happened to one scan of the log, in the log's order.
struct FrameRecord {
  TimeUs time_us = 0;
  /// Raw odometry; without any, the front end's pose. Of later drives, told on from where they begin.
  mrpt::math::TPose2D odom_T_robot;
  mrpt::math::TPose2D front_end_T_robot;  ///< the front end's own pose, before any loop was closed
  mrpt::math::TPose2D
      map_T_robot;  ///< the result: refined on what the scans near it saw, see refine_jointly()
  std::optional<std::size_t> node;  ///< its node in the graph, if it became one

  double response = 0;    ///< of the front end's match, in [0, 1]; 0 where there was nothing to match with
  SearchExtent window;    ///< the front end's search window (half-widths)
  double psi = 0;         ///< of equation 13, before the loops of this frame
  double eta = 0;         ///< of equation 14
  double mean_loops = 0;  ///< the mean of C_i in equation 13
  int loops_tried = 0;    ///< local maps that the frame was matched with to close a loop
  /// C_i of equation 13: the loops that became constraints at this frame, found here or on the way and
  /// confirmed here. Whether they are switched off later plays no part.
  int loops_accepted = 0;
  std::optional<MatcherKind> matcher;  ///< that searches for loops at this frame; none at other frames
  std::int64_t loop_evaluations = 0;  ///< poses scored to close loops, found or not
  std::int64_t evaluations = 0;       ///< these and the front end's together

  double front_end_ms = 0;
  double loop_matching_ms = 0;  ///< added up over the matches, which may run at the same time
  double loop_closing_ms = 0;   ///< from the first to the last of them, candidates and verification included
  double pose_graph_ms = 0;
};

/// What one matcher did to close loops, over the whole run.
struct LoopMatcherRecord {
  LoopEffort effort;
  LoopEffort final_search_effort;  ///< of `effort`, after the last scan
  std::size_t accepted = 0;     ///< constraints that the finished graph keeps
  std::size_t accepted_in_final_search = 0;
};

/// One local map, for drawings: its anchor node and the nodes whose scans it holds, [first_node, last_node].
struct LocalMapRecord {
  std::size_t anchor = 0;
  std::size_t first_node = 0;
  std::size_t last_node = 0;
};

struct MappingResult {
  std::vector<Frame> log;  ///< the scans themselves, same order and count as `frames`
  std::vector<FrameRecord> frames;
  PoseGraph
      graph;  ///< optimised, then refined with the scans: no longer the optimum of the constraints alone
  std::vector<std::size_t> node_frames;      ///< the frame of each node
  std::vector<std::size_t> later_run_frames;     ///< the first frame of each drive behind the first
  std::vector<LocalMapRecord> local_maps;
  std::vector<LoopRecord> loops;
  std::vector<std::string> unmet_edits;  ///< what a person asked for in vain, a sentence each
  PsiOptions psi;                        ///< its thresholds are drawn beside the factor
  std::map<MatcherKind, LoopMatcherRecord> loop_matchers;  ///< of the matchers that were used
  std::vector<StageTiming> stages;
  double wall_s = 0;         ///< of the whole run so far, loading included
  bool interrupted = false;  ///< true when the user stopped it before the log's end, or cut the last pass
  bool final_search_cut_short = false;       ///< not all pairs were tried, or scans not refined
  std::optional<std::string> broken_off;  ///< what is wrong with the log behind its last scan, as a sentence
};

/// Frames in a row, [begin, end).
struct FrameSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The frames of each drive: one, unless several were merged.
std::vector<FrameSpan> runs_of(const MappingResult& result);

/// The number of the first drive that loops do not join to drive 0, be it by way of others; none where all
/// hold together.
std::optional<std::size_t> unjoined_run(const MappingResult& result);

}  // namespace psi_slam
