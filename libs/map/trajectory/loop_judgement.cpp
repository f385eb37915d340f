// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/loop_judgement.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "map/trajectory/trajectory_file.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// A place on the robot's path.
struct PathPoint {
  TPose2D front_end_T_robot;
  double travelled_m = 0;
};

/// The path as the front end measured it, by scan and by time.
class FrontEndPath {
 public:
  FrontEndPath(const std::vector<FrameRecord>& frames, double max_gap_s)
      : max_gap_us_(static_cast<TimeUs>(std::llround(max_gap_s * 1e6))) {
    for (const FrameRecord& frame : frames) {
      double travelled_m = 0;
      if (!by_frame_.empty()) {
        const TPose2D motion = between(by_frame_.back().front_end_T_robot, frame.front_end_T_robot);
        travelled_m = by_frame_.back().travelled_m + portable::hypot(motion.x, motion.y);
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
    const TPose2D motion = between(before.front_end_T_robot, found->pose);
    return PathPoint{found->pose, before.travelled_m + portable::hypot(motion.x, motion.y)};
  }

 private:
  TimeUs max_gap_us_;
  std::vector<PathPoint> by_frame_;
  std::vector<std::size_t> frame_by_time_;
  Trajectory by_time_;
};

/// A relation on the path, in one of the two directions in which a loop can match it.
struct PlacedRelation {
  std::size_t relation = 0;
  PathPoint node_end;          ///< end of the relation that corresponds to the loop's node
  PathPoint map_end;           ///< end that corresponds to the loop's local map
  TPose2D map_end_T_node_end;  ///< true pose of the node end in the frame of the map end
};

/// A loop and its places on the path.
struct PlacedLoop {
  std::size_t loop = 0;
  PathPoint node;
  PathPoint anchor;
  double map_begin_m = 0;  ///< travelled distance at the first node of the local map
  double map_end_m = 0;    ///< travelled distance at the last node of the local map
  TPose2D anchor_T_node;   ///< pose of the node in the frame of the anchor, as matched
};

/// Places each relation on the path in both directions, one after the other. Skips relations with times
/// outside the path.
std::vector<PlacedRelation> place(const std::vector<Relation>& relations, const FrontEndPath& path) {
  std::vector<PlacedRelation> placed;
  for (std::size_t i = 0; i < relations.size(); ++i) {
    const auto end1 = path.at_time(relations[i].time1_us);
    const auto end2 = path.at_time(relations[i].time2_us);
    if (!end1 || !end2) continue;
    const TPose2D& end1_T_end2 = relations[i].pose1_T_pose2;
    placed.push_back({i, *end1, *end2, inverse(end1_T_end2)});
    placed.push_back({i, *end2, *end1, end1_T_end2});
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
    if (loop.state != LoopState::kAccepted) continue;
    const LocalMapRecord& map = result.local_maps.at(loop.local_map);
    placed.push_back({i, node(loop.node), node(loop.anchor), node(map.first_node).travelled_m,
                      node(map.last_node).travelled_m, loop.anchor_T_node});
  }
  return placed;
}

bool joins(const PlacedLoop& loop, const PlacedRelation& relation, double near_m) {
  return std::abs(relation.node_end.travelled_m - loop.node.travelled_m) <= near_m &&
         relation.map_end.travelled_m >= loop.map_begin_m - near_m &&
         relation.map_end.travelled_m <= loop.map_end_m + near_m;
}

double way_m(const PlacedLoop& loop, const PlacedRelation& relation) {
  return std::abs(relation.node_end.travelled_m - loop.node.travelled_m) +
         std::abs(relation.map_end.travelled_m - loop.anchor.travelled_m);
}

/// Returns the relation as predicted by the matched loop and the front end's motion to the ends of the
/// relation.
TPose2D predicted(const PlacedLoop& loop, const PlacedRelation& relation) {
  const TPose2D map_end_T_anchor = between(relation.map_end.front_end_T_robot, loop.anchor.front_end_T_robot);
  const TPose2D node_T_node_end = between(loop.node.front_end_T_robot, relation.node_end.front_end_T_robot);
  return compose(compose(map_end_T_anchor, loop.anchor_T_node), node_T_node_end);
}

JudgedLoop judge(const PlacedLoop& loop, const PlacedRelation& relation,
                 const LoopJudgementOptions& options) {
  const TPose2D error = between(relation.map_end_T_node_end, predicted(loop, relation));
  JudgedLoop judged{loop.loop, relation.relation, portable::hypot(error.x, error.y),
                    std::abs(mrpt::math::wrapToPi(error.phi)), way_m(loop, relation)};
  judged.is_false = judged.error_m > options.max_error_m + options.drift_m_per_metre * judged.way_m ||
                    judged.error_rad > options.max_error_rad + options.drift_rad_per_metre * judged.way_m;
  return judged;
}

/// Judges the loop by the nearest relation that joins the same places, if there is one.
std::optional<JudgedLoop> judge(const PlacedLoop& loop, const std::vector<PlacedRelation>& relations,
                                const LoopJudgementOptions& options) {
  std::optional<JudgedLoop> best;
  for (const PlacedRelation& relation : relations)
    if (joins(loop, relation, options.near_m) && !(best && best->way_m <= way_m(loop, relation)))
      best = judge(loop, relation, options);
  return best;
}

bool joins_two_passes(const PlacedRelation& relation, const LoopJudgementOptions& options) {
  return std::abs(relation.map_end.travelled_m - relation.node_end.travelled_m) >= options.min_travel_m &&
         portable::hypot(relation.map_end_T_node_end.x, relation.map_end_T_node_end.y) <=
             options.max_distance_m;
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
  for (std::size_t i = 0; i < placed.size(); i += 2) {
    const PlacedRelation& forward = placed[i];
    const PlacedRelation& backward = placed[i + 1];
    if (!joins_two_passes(backward, options)) continue;
    ++judgement.passes;
    judgement.joined += std::any_of(loops.begin(), loops.end(), [&](const PlacedLoop& loop) {
      return joins(loop, forward, options.near_m) || joins(loop, backward, options.near_m);
    });
  }
  return judgement;
}

}  // namespace psi_slam
