// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/scene_changes.h"

#include <gmock/gmock.h>

#include <utility>
#include <vector>

#include "changing_room.h"
#include "logs/frames/pose_operations.h"
#include "map/verdict/map_verdict.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The map of a room at true poses, with a node for each scan.
MappingResult map_of(const ChangingRoom& room) {
  MappingResult result;
  for (std::size_t i = 0; i < room.log.size(); ++i) {
    FrameRecord record;
    record.time_us = room.log[i].time_us;
    record.odom_T_robot = record.map_T_robot = room.poses[i];
    record.match = i == 0 ? ScanMatch::kNoMap : ScanMatch::kMatched;
    record.node = result.graph.add_node(room.poses[i]);
    if (i > 0) {
      Constraint step;
      step.from = i - 1;
      step.to = i;
      step.from_T_to = between(room.poses[i - 1], room.poses[i]);
      step.information = Eigen::Matrix3d::Identity() * 1e8;
      step.kind = Constraint::Kind::kLocalMap;
      result.graph.add_constraint(step);
    }
    result.node_frames.push_back(i);
    result.frames.push_back(record);
    result.log.push_back(room.log[i]);
  }
  result.local_maps = {{0, 0, result.node_frames.size() - 1}};
  return result;
}

class SceneChanges : public testing::Test {
 protected:
  void drive(int rounds, const RoomWalls& things) {
    for (int i = 0; i < rounds; ++i) room_.drive_round(things);
  }
  ChangingRoom room_;
};

TEST_F(SceneChanges, are_no_fault_of_the_poses) {
  drive(3, kWall + kShelf);
  const std::size_t change = room_.log.size();
  drive(3, kMovedWall + kDoor + kPallet);
  const MapVerdict verdict = judge_map(map_of(room_));
  EXPECT_EQ(verdict.state, MapState::kGood) << verdict_sentence(verdict);
  EXPECT_TRUE(verdict.hot_spots.empty());
  ASSERT_FALSE(verdict.changes.empty());
  const double change_s = 0.3 * static_cast<double>(change);
  EXPECT_LE(verdict.changes.front().before_s, change_s);
  EXPECT_GE(verdict.changes.front().after_s, change_s - 0.3);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("; the building changed at ("));
}

TEST_F(SceneChanges, have_a_time_that_all_comparisons_allow) {
  drive(1, kWall);
  const MappingResult map = map_of(room_);
  const std::vector<MapView> views = map_views(map);
  ASSERT_GT(views.size(), 9U);
  const auto found = [&](const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
    std::vector<PassCheck> checks;
    for (const auto& [view, other] : pairs) {
      PassCheck check;
      check.view = view;
      check.other = other;
      check.scene_changed = true;
      checks.push_back(check);
    }
    return scene_changes(map, views, checks, 1);
  };
  const std::vector<SceneChange> changes = found({{0, 5}, {9, 3}});
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_NEAR(changes.front().before_s, 0.3 * static_cast<double>(views[3].frame), 1e-6);
  EXPECT_NEAR(changes.front().after_s, 0.3 * static_cast<double>(views[5].frame), 1e-6);
  EXPECT_TRUE(found({{0, 5}, {6, 9}}).empty()) << "no single change explains both";
}

TEST_F(SceneChanges, are_not_found_in_a_room_that_stays) {
  drive(4, kWall + kShelf);
  EXPECT_TRUE(judge_map(map_of(room_)).changes.empty());
}

TEST_F(SceneChanges, do_not_excuse_poses_that_are_wrong) {
  drive(4, kWall + kShelf);
  for (const mrpt::math::TPose2D& off :
       {mrpt::math::TPose2D(0.4, 0, 0), mrpt::math::TPose2D(0, 0.4, 0), mrpt::math::TPose2D(0.3, 0.3, 0.05),
        mrpt::math::TPose2D(1.5, 0, 0), mrpt::math::TPose2D(0, 1.5, 0), mrpt::math::TPose2D(0, 0, 0.3)}) {
    ChangingRoom wrong = room_;
    for (std::size_t i = wrong.poses.size() / 2; i < wrong.poses.size(); ++i)
      wrong.poses[i] = compose(off, wrong.poses[i]);
    const MapVerdict verdict = judge_map(map_of(wrong));
    EXPECT_NE(verdict.state, MapState::kGood) << off << verdict_sentence(verdict);
    EXPECT_TRUE(verdict.changes.empty()) << off;
  }
}

TEST_F(SceneChanges, do_not_excuse_two_rooms_that_look_alike) {
  // Boxes stand along the walls of two rooms of one size. A false loop has put one onto the other.
  RoomWalls boxes;
  RoomWalls others;
  const auto put = [&](double x, double y, bool is_other) {
    RoomWalls& here = is_other ? others : boxes;
    here = here + box_at(x, y, 0.5, 0.5);
  };
  for (const double x : {1.3, 2.4, 3.9, 4.8, 6.4, 7.7}) {
    put(x, 0.05, false);
    put(9.4 - x, 6.45, true);
  }
  for (const double y : {1.4, 2.9, 4.3}) {
    put(0.05, y, false);
    put(9.45, 6.4 - y, true);
  }
  drive(2, boxes);
  drive(2, others);
  const MappingResult map = map_of(room_);
  const std::vector<MapView> views = map_views(map);
  std::size_t alike = 0;
  for (std::size_t view = 0; view < views.size(); ++view)
    for (std::size_t other = 0; other < view; ++other) {
      if (distance_m(views[view].map_T_robot, views[other].map_T_robot) > 0.5) continue;
      const auto check = compare_views(views, view, other, false, {});
      alike += check && check->scene_changed ? 1 : 0;
    }
  EXPECT_GT(alike, 10U) << "single scans look like a changed scene";
  const MapVerdict verdict = judge_map(map);
  EXPECT_EQ(verdict.state, MapState::kBroken) << verdict_sentence(verdict);
  EXPECT_TRUE(verdict.changes.empty());
}

}  // namespace
}  // namespace psi_slam
