// SPDX-License-Identifier: BSD-3-Clause
// Advised edits, carried out on the graph, give maps that are right against the truth.
#include "map/verdict/edit_advice.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "changing_room.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {
namespace {

constexpr double kStep_m = 0.005;    // standard deviation of a step of the path
constexpr double kStep_rad = 0.002;  // and of its heading

Eigen::Matrix3d information(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
      .asDiagonal();
}

/// Two rounds of a robot through a room, mapped with faults.
class EditAdviceTest : public testing::Test {
 protected:
  EditAdviceTest() {
    for (int i = 0; i < 2; ++i) room_.drive_round(kWall + kShelf);
    half_ = room_.log.size() / 2;
  }

  /// Steps are right, but the one to the second round has an error and this standard deviation. The path
  /// constraints begin at the first node of each segment of so many nodes.
  void build(const mrpt::math::TPose2D& slip, double slip_sigma_m, std::size_t segment = 1) {
    mrpt::math::TPose2D pose = room_.poses.front();
    for (std::size_t i = 0; i < room_.log.size(); ++i) {
      mrpt::math::TPose2D step = i == 0 ? mrpt::math::TPose2D() : between(room_.poses[i - 1], room_.poses[i]);
      if (i == half_) step = compose(step, slip);
      pose = compose(pose, step);
      FrameRecord record;
      record.time_us = room_.log[i].time_us;
      record.odom_T_robot = record.map_T_robot = pose;
      record.match = i == 0 ? ScanMatch::kNoMap : ScanMatch::kMatched;
      record.searched_loops = true;
      record.node = map_.graph.add_node(pose);
      const std::size_t first = i == 0 ? 0 : (i - 1) / segment * segment;
      if (i > 0)
        map_.graph.add_constraint({first,
                                   i,
                                   between(map_.graph.pose(first), pose),
                                   first < half_ && half_ <= i ? information(slip_sigma_m, slip_sigma_m)
                                                               : information(kStep_m, kStep_rad),
                                   Eigen::Matrix3d::Zero(),
                                   Constraint::Kind::kLocalMap,
                                   {}});
      map_.node_frames.push_back(i);
      map_.frames.push_back(record);
      map_.log.push_back(room_.log[i]);
    }
    for (std::size_t first = 0; first < room_.log.size(); first += half_ / 4)
      map_.local_maps.push_back({first, first, std::min(first + half_ / 4, room_.log.size()) - 1});
  }

  /// Adds an accepted loop that measures the true pose, moved by `off`.
  void add_loop(std::size_t reference, std::size_t node, const mrpt::math::TPose2D& off) {
    LoopRecord loop;
    loop.anchor = loop.reference = reference;
    loop.node = loop.frame = node;
    loop.local_map = reference / (half_ / 4);
    loop.reference_T_node = loop.anchor_T_node =
        compose(between(room_.poses[reference], room_.poses[node]), off);
    loop.covariance = information(0.02, 0.01).inverse();
    loop.state = LoopState::kAccepted;
    map_.loops.push_back(loop);
    Constraint constraint{reference,
                          node,
                          loop.reference_T_node,
                          information(0.02, 0.01),
                          Eigen::Matrix3d::Zero(),
                          Constraint::Kind::kLoop,
                          RobustKernel{}};
    map_.graph.add_constraint(constraint);
    settle();
  }

  void settle() {
    SparsePoseAdjustment().optimize(map_.graph);
    for (std::size_t i = 0; i < map_.frames.size(); ++i) map_.frames[i].map_T_robot = map_.graph.pose(i);
  }

  double worst_error_m() const {
    double worst_m = 0;
    for (std::size_t i = 0; i < map_.frames.size(); ++i)
      worst_m = std::max(worst_m, distance_m(map_.frames[i].map_T_robot, room_.poses[i]));
    return worst_m;
  }

  ChangingRoom room_;
  std::size_t half_ = 0;
  MappingResult map_;
};

TEST_F(EditAdviceTest, deletes_a_false_loop) {
  build({}, kStep_m);
  for (const std::size_t node : {5U, 40U, 75U}) add_loop(node, half_ + node, {});
  add_loop(20, half_ + 20, {0.9, 0.6, 0});
  ASSERT_GT(worst_error_m(), 0.2);
  const MapVerdict verdict = judge_map(map_);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const auto spot = std::find_if(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                                 [](const HotSpot& one) { return one.edit.has_value(); });
  ASSERT_NE(spot, verdict.hot_spots.end()) << verdict_sentence(verdict);
  EXPECT_EQ(spot->edit->kind, LoopEdit::Kind::kDelete);
  const double before_m = worst_error_m();
  map_.graph.set_enabled(map_.graph.num_constraints() - 1, false);
  settle();
  EXPECT_LT(worst_error_m(), 0.05);
  EXPECT_NEAR(spot->effect->moved_m, before_m, 0.05);
}

TEST_F(EditAdviceTest, matches_a_scan_after_a_slip) {
  build({0.5, 0.3, 0.1}, 0.5);
  const double before_m = worst_error_m();
  ASSERT_GT(before_m, 0.4);
  const MapVerdict verdict = judge_map(map_);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const HotSpot& spot = verdict.hot_spots.front();
  ASSERT_TRUE(spot.edit) << verdict_sentence(verdict);
  EXPECT_EQ(spot.edit->kind, LoopEdit::Kind::kMatch);
  EXPECT_LT(map_.local_maps.at(spot.edit->local_map).last_node, spot.edit->frame);
  EXPECT_NEAR(spot.effect->moved_m, before_m, 0.15 * before_m);
  add_loop(map_.local_maps[spot.edit->local_map].first_node, spot.edit->frame, {});
  EXPECT_LT(worst_error_m(), 0.1);
  EXPECT_EQ(judge_map(map_).state, MapState::kGood);
}

// The slip is within a segment of the path. All scans of the segment after the slip move with the matched
// one.
TEST_F(EditAdviceTest, a_tried_match_keeps_the_path_after_the_slip_together) {
  build({0.5, 0.3, 0.1}, 0.5, room_.log.size());
  const MapVerdict verdict = judge_map(map_);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const HotSpot& spot = verdict.hot_spots.front();
  ASSERT_TRUE(spot.edit) << verdict_sentence(verdict);
  EXPECT_EQ(spot.edit->kind, LoopEdit::Kind::kMatch);
  EXPECT_NEAR(spot.effect->moved_m, worst_error_m(), 0.15 * worst_error_m());
}

TEST_F(EditAdviceTest, deletes_no_loop_that_is_true) {
  build({0.5, 0.3, 0.1}, 0.5);
  add_loop(20, half_ + 20, {});
  add_loop(60, half_ + 60, {});
  add_loop(40, half_ + 40, {0.9, 0.6, 0});
  const MapVerdict verdict = judge_map(map_);
  ASSERT_FALSE(verdict.hot_spots.empty());
  for (const HotSpot& spot : verdict.hot_spots)
    if (spot.edit && spot.edit->kind == LoopEdit::Kind::kDelete) {
      EXPECT_EQ(spot.edit->frame, half_ + 40) << edit_line(spot);
    }
}

TEST_F(EditAdviceTest, forces_a_match_as_the_mapper_does) {
  build({0.5, 0.3, 0.1}, 0.5);
  const double before_m = worst_error_m();
  add_loop(20, half_ + 20, {});
  const std::size_t constraint = map_.graph.num_constraints() - 1;
  map_.graph.set_enabled(constraint, false);
  map_.loops.back().by_hand = true;
  reject(map_.loops.back(), {LoopRejection::Reason::kContradicted});
  LoopRecord older = map_.loops.back();
  older.reference_T_node = compose(older.reference_T_node, {1, 0, 0});
  map_.loops.insert(map_.loops.begin(), older);
  settle();
  const MapVerdict verdict = judge_map(map_);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const HotSpot& spot = verdict.hot_spots.front();
  ASSERT_TRUE(spot.edit) << verdict_sentence(verdict);
  EXPECT_EQ(spot.edit->kind, LoopEdit::Kind::kForce) << "of the newest record";
  map_.graph.set_enabled(constraint, true);
  settle();
  EXPECT_LT(worst_error_m(), 0.1);
  EXPECT_NEAR(spot.effect->moved_m, before_m, 0.1);
}

}  // namespace
}  // namespace psi_slam
