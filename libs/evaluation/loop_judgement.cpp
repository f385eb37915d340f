// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/loop_judgement.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "frames/pose_operations.h"
#include "trajectory/pose_at_time.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// A place on the robot's path.
struct PathPoint {
  TPose2D front_end_T_robot;
  double travelled_m = 0;
};

/// The path as the front end saw it, by scan and by time.
class FrontEndPath {
 public:
  FrontEndPath(const std::vector<FrameRecord>& frames, double max_gap_s)
      : max_gap_us_(static_cast<TimeUs>(std::llround(max_gap_s * 1e6))) {
    for (const FrameRecord& frame : frames) {
      double travelled_m = 0;
      if (!by_frame_.empty()) {
        const TPose2D motion = frame.front_end_T_robot - by_frame_.back().front_end_T_robot;
        travelled_m = by_frame_.back().travelled_m + std::hypot(motion.x, motion.y);
      }
      by_frame_.push_back({frame.front_end_T_robot, travelled_m});
    }
    frame_by_time_.resize(frames.size());
    std::iota(frame_by_time_.begin(), frame_by_time_.end(), std::size_t{0});
    std::stable_sort(frame_by_time_.begin(), frame_by_time_.end(),
                     [&](std::size_t a, std::size_t b) { return frames[a].time_us < frames[b].time_us; });
    for (const std::size_t frame : frame_by_time_)
      by_time_.push_back({frames[frame].time_us, frames[frame].front_end_T_robot});
  }

  const PathPoint& at_frame(std::size_t frame) const { return by_frame_.at(frame); }

  std::optional<PathPoint> at_time(TimeUs time_us) const {
    const auto found = pose_at_time(by_time_, time_us, max_gap_us_);
    if (!found) return std::nullopt;
    const PathPoint& before = by_frame_[frame_by_time_[found->from]];
    const TPose2D motion = found->pose - before.front_end_T_robot;
    return PathPoint{found->pose, before.travelled_m + std::hypot(motion.x, motion.y)};
  }

 private:
  TimeUs max_gap_us_;
  std::vector<PathPoint> by_frame_;
  std::vector<std::size_t> frame_by_time_;
  Trajectory by_time_;
};

/// A relation on the path.
struct PlacedRelation {
  std::size_t relation = 0;
  PathPoint end1;
  PathPoint end2;
  TPose2D end1_T_end2;  ///< the truth
};

/// A loop on the path.
struct PlacedLoop {
  std::size_t loop = 0;
  PathPoint node;
  PathPoint anchor;
  double map_begin_m = 0;  ///< of the path, where the local map was filled
  double map_end_m = 0;
  TPose2D anchor_T_node;  ///< as matched
};

std::vector<PlacedRelation> place(const std::vector<Relation>& relations, const FrontEndPath& path) {
  std::vector<PlacedRelation> placed;
  for (std::size_t i = 0; i < relations.size(); ++i) {
    const auto end1 = path.at_time(relations[i].time1_us);
    const auto end2 = path.at_time(relations[i].time2_us);
    if (end1 && end2) placed.push_back({i, *end1, *end2, relations[i].pose1_T_pose2});
  }
  return placed;
}

std::vector<PlacedLoop> place_accepted_loops(const MappingResult& result, const FrontEndPath& path) {
  const auto node = [&](std::size_t number) -> const PathPoint& {
    return path.at_frame(result.node_frames.at(number));
  };
  std::vector<PlacedLoop> placed;
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopRecord& loop = result.loops[i];
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    const LocalMapRecord& map = result.local_maps.at(loop.local_map);
    placed.push_back({i, node(loop.node), node(loop.anchor), node(map.first_node).travelled_m,
                      node(map.last_node).travelled_m, loop.anchor_T_node});
  }
  return placed;
}

bool joins(const PlacedLoop& loop, const PathPoint& node_end, const PathPoint& map_end, double near_m) {
  return std::abs(node_end.travelled_m - loop.node.travelled_m) <= near_m &&
         map_end.travelled_m >= loop.map_begin_m - near_m && map_end.travelled_m <= loop.map_end_m + near_m;
}

double way_m(const PlacedLoop& loop, const PathPoint& node_end, const PathPoint& map_end) {
  return std::abs(node_end.travelled_m - loop.node.travelled_m) +
         std::abs(map_end.travelled_m - loop.anchor.travelled_m);
}

/// What the loop and the front end make of the relation from the local map's end to the node's.
TPose2D predicted(const PlacedLoop& loop, const PathPoint& node_end, const PathPoint& map_end) {
  const TPose2D map_end_T_anchor = loop.anchor.front_end_T_robot - map_end.front_end_T_robot;
  const TPose2D node_T_node_end = node_end.front_end_T_robot - loop.node.front_end_T_robot;
  return map_end_T_anchor + loop.anchor_T_node + node_T_node_end;
}

JudgedLoop judge(const PlacedLoop& loop, const PlacedRelation& relation, bool node_at_end1,
                 const LoopJudgementOptions& options) {
  const PathPoint& node_end = node_at_end1 ? relation.end1 : relation.end2;
  const PathPoint& map_end = node_at_end1 ? relation.end2 : relation.end1;
  const TPose2D truth = node_at_end1 ? inverse(relation.end1_T_end2) : relation.end1_T_end2;
  const TPose2D error = predicted(loop, node_end, map_end) - truth;
  JudgedLoop judged{loop.loop, relation.relation, std::hypot(error.x, error.y),
                    std::abs(mrpt::math::wrapToPi(error.phi)), way_m(loop, node_end, map_end)};
  judged.is_false = judged.error_m > options.max_error_m + options.drift_m_per_metre * judged.way_m ||
                    judged.error_rad > options.max_error_rad + options.drift_rad_per_metre * judged.way_m;
  return judged;
}

/// By the relation with the shortest way; none when no relation joins what the loop joins.
std::optional<JudgedLoop> judge(const PlacedLoop& loop, const std::vector<PlacedRelation>& relations,
                                const LoopJudgementOptions& options) {
  std::optional<JudgedLoop> best;
  for (const PlacedRelation& relation : relations) {
    for (const bool node_at_end1 : {true, false}) {
      const PathPoint& node_end = node_at_end1 ? relation.end1 : relation.end2;
      const PathPoint& map_end = node_at_end1 ? relation.end2 : relation.end1;
      if (!joins(loop, node_end, map_end, options.near_m)) continue;
      if (best && best->way_m <= way_m(loop, node_end, map_end)) continue;
      best = judge(loop, relation, node_at_end1, options);
    }
  }
  return best;
}

bool joins_two_passes(const PlacedRelation& relation, const LoopJudgementOptions& options) {
  return std::abs(relation.end2.travelled_m - relation.end1.travelled_m) >= options.min_travel_m &&
         std::hypot(relation.end1_T_end2.x, relation.end1_T_end2.y) <= options.max_distance_m;
}

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<double> LoopJudgement::precision() const {
  return share(judged.size() - false_ones.size(), judged.size());
}

std::optional<double> LoopJudgement::recall() const {
  return share(joined, passes);
}

LoopJudgement judge_loops(const MappingResult& result, const std::vector<Relation>& relations,
                          const LoopJudgementOptions& options) {
  const FrontEndPath path(result.frames, options.max_gap_s);
  const std::vector<PlacedRelation> placed = place(relations, path);
  const std::vector<PlacedLoop> loops = place_accepted_loops(result, path);
  LoopJudgement judgement;
  for (const PlacedLoop& loop : loops) {
    const auto judged = judge(loop, placed, options);
    if (!judged) {
      ++judgement.unjudged;
      continue;
    }
    judgement.judged.push_back(*judged);
    if (judged->is_false) judgement.false_ones.push_back(*judged);
  }
  for (const PlacedRelation& relation : placed) {
    if (!joins_two_passes(relation, options)) continue;
    ++judgement.passes;
    judgement.joined += std::any_of(loops.begin(), loops.end(), [&](const PlacedLoop& loop) {
      return joins(loop, relation.end1, relation.end2, options.near_m) ||
             joins(loop, relation.end2, relation.end1, options.near_m);
    });
  }
  return judgement;
}

}  // namespace psi_slam
