// SPDX-License-Identifier: BSD-3-Clause
// What a mapping run leaves behind: plain values that the exports, the report and the views read.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/logs/frame.h"
#include "psi_slam/loop_closure/loop_record.h"
#include "psi_slam/mapping/stage_clock.h"
#include "psi_slam/matching/search_window.h"

namespace psi_slam {

/// What happened to one scan of the log, in the log's order.
struct FrameRecord {
  TimeUs time_us = 0;
  mrpt::math::TPose2D odom_T_robot;       ///< raw odometry
  mrpt::math::TPose2D front_end_T_robot;  ///< the front end's own pose, before any loop was closed
  mrpt::math::TPose2D map_T_robot;        ///< the result: its node's pose, or its matched pose carried along
  std::optional<std::size_t> node;        ///< its node in the graph, if it became one

  double response = 0;     ///< of the front end's match, in [0, 1]; 0 where there was nothing to match with
  SearchExtent window;     ///< the front end's search window (half-widths)
  int loops_tried = 0;     ///< local maps that the frame was matched with to close a loop
  int loops_accepted = 0;  ///< C_i of equation 13
  std::string matcher;     ///< that searched the loops of this frame: "csm", ...; empty where none was tried
  std::int64_t evaluations = 0;  ///< poses scored, front end and loops together

  double front_end_ms = 0;
  double loop_closing_ms = 0;
  double pose_graph_ms = 0;
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
  mrpt::graphs::CNetworkOfPoses2DInf graph;  ///< optimised; node ids are 0 .. N-1
  std::vector<std::size_t> node_frames;      ///< the frame of each node
  std::vector<LocalMapRecord> local_maps;
  std::vector<LoopRecord> loops;
  std::vector<StageTiming> stages;
  double wall_s = 0;         ///< of the whole run so far, loading included
  bool interrupted = false;  ///< true when the user stopped it before the log's end, or cut the last pass
  bool last_pass_cut_short = false;       ///< some of its pairs were not tried
  std::optional<std::string> broken_off;  ///< what is wrong with the log behind its last scan, as a sentence
};

}  // namespace psi_slam
