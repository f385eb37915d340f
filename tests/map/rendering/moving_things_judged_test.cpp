// SPDX-License-Identifier: BSD-3-Clause
// Draws rooms in which things come, go and move, and compares the map with the newest state of the room.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "changing_room.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {
namespace {

/// Shares of the points of some walls, 0.2 m and more from their ends, that the map draws as occupied within
/// 0.1 m, and as free within 0.05 m without any occupied cell within 0.1 m.
struct Drawn {
  double occupied = 0;
  double free = 0;
};

Drawn drawn(const mrpt::maps::COccupancyGridMap2D& map, const RoomWalls& walls) {
  Drawn shares;
  int points = 0;
  for (const RoomWall& wall : walls) {
    const mrpt::math::TPoint2D way = wall.b - wall.a;
    const double length_m = std::hypot(way.x, way.y);
    for (double s = 0.2; s < length_m - 0.19; s += 0.05) {
      const mrpt::math::TPoint2D at = wall.a + way * (s / length_m);
      bool is_occupied = false;
      bool is_free = true;
      for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y) {
          const float free =
              map.getPos(static_cast<float>(at.x + 0.05 * x), static_cast<float>(at.y + 0.05 * y));
          is_occupied = is_occupied || free < 0.45F;
          is_free = is_free && (free > 0.55F || std::max(std::abs(x), std::abs(y)) == 2);
        }
      ++points;
      shares.occupied += is_occupied ? 1 : 0;
      shares.free += is_free && !is_occupied ? 1 : 0;
    }
  }
  shares.occupied /= points;
  shares.free /= points;
  return shares;
}

struct Change {
  std::string name;
  int rounds_before = 1;
  int rounds_after = 1;
  RoomWalls gone;  ///< things that are there only before
  RoomWalls come;  ///< and only after
};

void PrintTo(const Change& change, std::ostream* out) {
  *out << change.name;
}

class ChangeOfARoom : public testing::TestWithParam<Change> {};

TEST_P(ChangeOfARoom, is_drawn_as_its_newest_state) {
  const Change& change = GetParam();
  ChangingRoom room;
  for (int i = 0; i < change.rounds_before; ++i) room.drive_round(change.gone);
  for (int i = 0; i < change.rounds_after; ++i) room.drive_round(change.come);
  const auto map = draw_grid_map(room.log, room.poses);
  if (!change.come.empty()) {
    EXPECT_GE(drawn(*map, change.come).occupied, 0.95);
    EXPECT_EQ(drawn(*map, change.come).free, 0);
  }
  if (!change.gone.empty()) {
    EXPECT_LE(drawn(*map, change.gone).occupied, 0.05);
  }
  EXPECT_GE(drawn(*map, bare_room()).occupied, 0.9);
}

INSTANTIATE_TEST_SUITE_P(
    Rounds, ChangeOfARoom,
    testing::Values(
        Change{"a pallet comes early", 1, 4, {}, kPallet}, Change{"a pallet comes", 3, 3, {}, kPallet},
        Change{"a pallet comes late", 8, 2, {}, kPallet}, Change{"a door closes", 3, 3, {}, kDoor},
        Change{"a door closes late", 7, 2, {}, kDoor}, Change{"a door opens", 4, 2, kDoor, {}},
        Change{"a shelf goes", 3, 3, kShelf, {}}, Change{"a shelf goes late", 6, 2, kShelf, {}},
        Change{"a wall moves", 3, 3, kWall, kMovedWall}, Change{"a wall moves late", 5, 2, kWall, kMovedWall},
        Change{"much changes", 3, 3, kWall + kShelf, kMovedWall + kDoor + kPallet}));

TEST(ChangesOfARoom, a_door_that_opens_and_closes_is_drawn_as_it_was_last) {
  ChangingRoom room;
  for (int i = 0; i < 3; ++i) {
    room.drive_round(kDoor);
    room.drive_round({});
  }
  room.drive_round({});
  EXPECT_LE(drawn(*draw_grid_map(room.log, room.poses), kDoor).occupied, 0.05);
  room.drive_round(kDoor);
  room.drive_round(kDoor);
  EXPECT_GE(drawn(*draw_grid_map(room.log, room.poses), kDoor).occupied, 0.95);
}

TEST(ChangesOfARoom, a_thing_that_one_pass_saw_last_is_not_free) {
  ChangingRoom room;
  for (int i = 0; i < 3; ++i) room.drive_round({});
  for (double x = 1.7; x < 6; x += 0.2) room.record({x, 1.5, 0}, kPallet);
  EXPECT_EQ(drawn(*draw_grid_map(room.log, room.poses), {kPallet[0]}).free, 0);
}

TEST(ChangesOfARoom, a_pallet_whose_place_was_seen_free_only_from_afar_is_not_free) {
  const RoomWalls hall{{{0, 0}, {30, 0}}, {{30, 0}, {30, 6}}, {{30, 6}, {0, 6}}, {{0, 6}, {0, 0}}};
  const RoomWalls pallet = box_at(25, 2.6, 0.7, 0.6);
  ChangingRoom room(720, hall);
  const auto drive = [&](double first_x, double last_x, const RoomWalls& things) {
    for (double x = first_x; x < last_x; x += 0.2) room.record({x, 2.2, 0}, things);
    for (double x = last_x; x > first_x; x -= 0.2) room.record({x, 3.8, M_PI}, things);
  };
  for (int i = 0; i < 8; ++i) drive(2, 10, {});
  drive(17, 23, pallet);
  const RoomWalls front{pallet[3]};
  EXPECT_EQ(drawn(*draw_grid_map(room.log, room.poses), front).free, 0);
  for (int i = 0; i < 4; ++i) drive(17, 23, pallet);
  EXPECT_GE(drawn(*draw_grid_map(room.log, room.poses), front).occupied, 0.95);
}

TEST(ChangesOfARoom, a_pane_that_not_all_passes_see_stays) {
  ChangingRoom room;
  for (const int seen : {4, 2}) {
    for (int pass = 0; pass < seen; ++pass) room.drive_round(kWall);
    for (int pass = 0; pass < 2; ++pass) room.drive_round({});
  }
  EXPECT_GE(drawn(*draw_grid_map(room.log, room.poses), kWall).occupied, 0.95);
}

TEST(ChangesOfARoom, passes_at_wrong_poses_remove_no_wall) {
  ChangingRoom room;
  for (int i = 0; i < 3; ++i) room.drive_round(kWall);
  const std::size_t change = room.log.size();
  for (int i = 0; i < 2; ++i) room.drive_round({});
  EXPECT_LE(drawn(*draw_grid_map(room.log, room.poses), kWall).occupied, 0.05);
  for (std::size_t i = change; i < change * 3 / 2; ++i) room.poses[i].y += 0.5;
  EXPECT_GE(drawn(*draw_grid_map(room.log, room.poses), kWall).occupied, 0.95);
}

TEST(ChangesOfARoom, a_person_who_stood_there_for_two_rounds_vanishes_afterwards) {
  const RoomWalls person = box_at(7.4, 2.4, 0.45, 0.45);
  ChangingRoom room;
  room.drive_round({});
  for (int i = 0; i < 2; ++i) room.drive_round(person);
  for (int i = 0; i < 2; ++i) room.drive_round({});
  EXPECT_LE(drawn(*draw_grid_map(room.log, room.poses), person).occupied, 0.05);
}

TEST(ChangesOfARoom, a_wall_in_two_places_by_wrong_poses_stays) {
  ChangingRoom room;
  for (int i = 0; i < 4; ++i) room.drive_round(kWall);
  for (std::size_t i = room.poses.size() / 2; i < room.poses.size(); ++i) room.poses[i].y += 0.4;
  const auto map = draw_grid_map(room.log, room.poses);
  EXPECT_GE(drawn(*map, kWall).occupied, 0.95);
  RoomWalls displaced = kWall;
  for (RoomWall& wall : displaced) {
    wall.a.y += 0.4;
    wall.b.y += 0.4;
  }
  EXPECT_GE(drawn(*map, displaced).occupied, 0.95);
}

}  // namespace
}  // namespace psi_slam
