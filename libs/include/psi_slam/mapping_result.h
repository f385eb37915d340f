// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The result of mapping: plain values that exports, reports and views read.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
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

/// Outcome of matching a scan with a local map in the front end.
enum class ScanMatch {
  kNoMap,      ///< no local map existed yet: the first scan of a run
  kMatched,    ///< the scan matches; its pose is that of the match
  kUnmatched,  ///< the scan does not match; its pose is predicted by odometry, or else by constant velocity
};

/// Poses, matches, loops and times of one scan of the log.
struct FrameRecord {
  TimeUs time_us = 0;  ///< time of the scan, microseconds
  /// Pose by odometry; without odometry, the front end's pose. The odometry of a later run continues from the
  /// place in the map where that run begins.
  mrpt::math::TPose2D odom_T_robot;
  mrpt::math::TPose2D front_end_T_robot;  ///< pose of the robot by the front end, without loop closing
  /// Pose of the robot in the map. Mapper::finish() corrects and refines it.
  mrpt::math::TPose2D map_T_robot;
  std::optional<std::size_t> node;  ///< node of this scan in the pose graph; empty if it is no node

  ScanMatch match = ScanMatch::kNoMap;  ///< whether the scan was matched with a local map

  double response = 0;  ///< response of the front end's match, in [0, 1]; 0 without a match
  SearchExtent window;  ///< half-widths of the front end's search window
  double psi = 0;       ///< factor Psi (equation 13), computed before the loops of this frame
  double eta = 0;       ///< factor eta (equation 14)
  /// Mean of C_i (see loops_accepted) over the last nodes that searched for loops, equation 13.
  double mean_loops = 0;
  int loops_tried = 0;  ///< number of local maps matched with this frame to close loops
  /// C_i of equation 13: number of loops that became constraints at this frame. Includes candidates of
  /// earlier frames that this frame confirmed, and loops that are rejected later.
  int loops_accepted = 0;
  bool searched_loops = false;  ///< whether this frame searched for loops, possibly without candidates
  /// Matcher that Psi or a setting chose for the loops of this frame; empty if it is no node. If Psi chose,
  /// kGa searches large windows instead, see LoopRecord::matcher.
  std::optional<MatcherKind> matcher;
  /// Number of searches that ran for the loops of this frame, in the order of kSearchKinds.
  std::array<int, kSearchKinds.size()> searches{};
  std::int64_t loop_evaluations = 0;  ///< number of poses scored to close loops
  std::int64_t evaluations = 0;       ///< number of poses scored by loop closing and the front end

  /// Time of matching and of insertion into the local maps; with several threads, into the older one.
  double front_end_ms = 0;
  double loop_matching_ms = 0;  ///< time of loop matching, summed over matches that may run in parallel
  double loop_closing_ms = 0;   ///< wall time of loop closing, with candidates and verification
  double pose_graph_ms = 0;     ///< time of optimising the graph
};

/// Loop searches of one matcher, over the whole run.
struct LoopMatcherRecord {
  LoopEffort effort;                         ///< cost of all searches by this matcher
  LoopEffort final_search_effort;            ///< part of `effort` spent in the final search
  std::size_t accepted = 0;                  ///< accepted loops in the finished graph
  std::size_t accepted_in_final_search = 0;  ///< part of `accepted` found in the final search
  /// `accepted` by the search that found the loop, in the order of kSearchKinds.
  std::array<std::size_t, kSearchKinds.size()> accepted_by_search{};
};

/// Node numbers of one local map.
struct LocalMapRecord {
  std::size_t anchor = 0;      ///< node whose pose is the frame of the local map
  std::size_t first_node = 0;  ///< first node whose scan the map holds
  std::size_t last_node = 0;   ///< last node whose scan the map holds
};

/// An interruption of the log after which the robot was at an unknown place: moved by hand, or switched off
/// and on elsewhere. A new run begins there.
struct Interruption {
  std::size_t frame = 0;  ///< first frame after the interruption
  /// Frame that found the robot's place in the map; empty if the place was never found. Then the run is drawn
  /// beside the map.
  std::optional<std::size_t> found_frame;
};

/// Time spent in one stage of the work, over all its calls.
struct StageTiming {
  std::string name;       ///< label of the stage, such as "match scan"
  std::size_t calls = 0;  ///< number of calls
  double mean_ms = 0;     ///< mean time of a call
  double std_ms = 0;      ///< standard deviation of the time of a call
  double min_ms = 0;      ///< time of the shortest call
  double max_ms = 0;      ///< time of the longest call
  double total_s = 0;     ///< sum of the times of all calls; several threads may overlap
};

/// Thresholds of the factor Psi, see PsiOptions.
struct PsiThresholds {
  double psi_1 = 0;  ///< up to this Psi, kCsm searches windows of at most max_poses poses
  double psi_2 = 0;  ///< from this Psi on, kGa searches for loops
};

/// Number of statements from outside that a map uses: poses, places of tags and sightings. Places found in a
/// prior map do not count.
struct KnowledgeCounts {
  std::size_t used = 0;      ///< statements that are constraints of the graph
  std::size_t left_out = 0;  ///< all others, each of which MappingResult::contradictions names
};

/// A finished map: scans, poses, graph and loops, with statistics of the mapping.
struct MappingResult {
  /// All scans, in the order of `frames`. Most lack their ranges at a standstill, and all where later passes
  /// of the robot supersede them.
  std::vector<Frame> log;
  std::vector<FrameRecord> frames;  ///< one record for each scan, with its pose in the map
  /// Pose graph, optimised and then refined jointly with all scans. Optimising the graph again undoes the
  /// refinement. If poses or tags are known from outside, the nodes of the scans are followed by the frame of
  /// the site, which is the root, and by a node for each known pose and tag, see FixedKnowledge.
  PoseGraph graph;
  std::vector<std::size_t> node_frames;       ///< frame number of each node
  std::vector<std::size_t> later_run_frames;  ///< number of the first frame of each run after the first
  std::vector<Interruption> interruptions;    ///< interruptions at which the place of the robot was lost
  std::vector<LocalMapRecord> local_maps;     ///< all local maps, in the order in which they began
  /// Attempts to close loops. Attempts of the final loop search are kept only if they found a match.
  std::vector<LoopRecord> loops;
  std::vector<std::string> unmet_edits;  ///< edits that could not be made, one sentence each
  /// One sentence for each forced loop that the path and the other loops contradict, and for each known pose,
  /// landmark or prior map that contradicts the scans or another such statement, or that could not be used.
  std::vector<std::string> contradictions;
  KnowledgeCounts knowledge;                               ///< statements from outside
  PsiThresholds psi;                                       ///< thresholds by which Psi chose the matchers
  std::map<MatcherKind, LoopMatcherRecord> loop_matchers;  ///< loop searches of each matcher that was used
  std::vector<StageTiming> stages;                         ///< times of the stages of the work
  double wall_s = 0;                    ///< wall time of the work up to the last export; 0 before an export
  bool interrupted = false;             ///< true: the log was not read to its end, or finish() was cut short
  bool final_search_cut_short = false;  ///< true: finish() skipped loop searches or the refinement
  std::optional<std::string> broken_off;  ///< damage of the log after its last readable scan, as a sentence
};

/// Consecutive frames, [begin, end).
struct FrameSpan {
  std::size_t begin = 0;  ///< first frame
  std::size_t end = 0;    ///< frame after the last
};

/// Returns the frames of each run: one span unless several runs were merged.
std::vector<FrameSpan> runs_of(const MappingResult& result);
/// Returns the frames of each run, for `frames` frames in total. `later_run_frames` is as in MappingResult.
std::vector<FrameSpan> runs_of(std::size_t frames, const std::vector<std::size_t>& later_run_frames);

/// Returns the frames of each log: one span unless several logs were merged. Runs that begin at an
/// interruption belong to the log before them.
std::vector<FrameSpan> logs_of(const MappingResult& result);

/// Returns the index, as in logs_of(), of the first log that no chain of accepted loops joins to log 0; empty
/// if all logs are joined. A chain may not pass through an interruption without a loop across it.
std::optional<std::size_t> unjoined_log(const MappingResult& result);

}  // namespace psi_slam
