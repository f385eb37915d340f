// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/live_grid_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "logs/frames/discarded_ranges.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// A robot in a room, with returns, beams without return and invalid readings, and a second laser.
class LiveGridMapTest : public testing::Test {
 protected:
  LiveGridMapTest() {
    const MappingResult walk = walk_around_the_room(60);
    std::mt19937_64 random(3);
    for (std::size_t i = 0; i < walk.log.size(); ++i) {
      Frame frame = walk.log[i];
      for (float& range_m : frame.scan.ranges_m) {
        if (random() % 10 == 0) range_m = std::numeric_limits<float>::infinity();
        if (random() % 10 == 0) range_m = std::numeric_limits<float>::quiet_NaN();
      }
      CompanionScan companion;
      companion.scan = walk.log[i].scan;
      companion.scan.laser = 1;
      companion.scan.robot_T_laser = {-0.2, 0.1, M_PI};
      companion.frame_T_robot = {0.01, 0, 0.02};
      frame.companions.push_back(companion);
      all_.push_back(frame);
      poses_.push_back(walk.frames[i].map_T_robot);
    }
  }

  /// Adds the next `count` frames and updates the map.
  void drive(std::size_t count) {
    while (count-- > 0) {
      log_.push_back(all_[log_.size()]);
      update();
    }
  }

  void update() {
    map_.update(log_, [this](std::size_t i) { return poses_[i]; });
  }

  /// Moves all poses as a loop does: the later, the farther.
  void correct(double metres) {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(poses_.size());
      poses_[i] = TPose2D(metres * share, -metres * share, 0.1 * metres * share) + poses_[i];
    }
  }

  void settle() {
    int calls = 0;
    do update();
    while (!map_.is_settled() && ++calls < 1000);
    ASSERT_TRUE(map_.is_settled());
  }

  /// Expects the map that draw_grid_map() gives with the same scans at the same poses.
  void expect_equal_to_a_full_drawing() {
    std::vector<TPose2D> drawn;
    for (std::size_t i = 0; i < log_.size(); ++i) drawn.push_back(map_.drawn_pose(i));
    GridMapOptions everything = options_.map;
    everything.keep_moving = true;
    everything.min_beams = 1;
    const auto expected = draw_grid_map(log_, drawn, everything);
    const auto grid = grid_of(map_.snapshot());
    EXPECT_EQ(grid->getXMin(), expected->getXMin());
    EXPECT_EQ(grid->getYMax(), expected->getYMax());
    EXPECT_EQ(grid->getResolution(), expected->getResolution());
    ASSERT_EQ(grid->getSizeX(), expected->getSizeX());
    EXPECT_EQ(grid->getRawMap(), expected->getRawMap());
  }

  std::vector<Frame> all_;
  std::vector<Frame> log_;
  std::vector<TPose2D> poses_;
  LiveGridOptions options_;
  LiveGridMap map_{options_};
};

TEST_F(LiveGridMapTest, equals_a_full_drawing_after_each_scan) {
  expect_equal_to_a_full_drawing();
  for (int i = 0; i < 60; ++i) {
    drive(1);
    expect_equal_to_a_full_drawing();
  }
  EXPECT_EQ(map_.work(), 60U) << "each scan is drawn once";
}

TEST_F(LiveGridMapTest, draws_all_moved_scans_again_over_several_calls) {
  drive(50);
  const auto before = grid_of(map_.snapshot());
  correct(0.8);
  update();
  EXPECT_FALSE(map_.is_settled());
  settle();
  expect_equal_to_a_full_drawing();
  EXPECT_NE(grid_of(map_.snapshot())->getRawMap(), before->getRawMap());
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_TRUE(is_same_place(map_.drawn_pose(i), poses_[i], options_.moved)) << i;
}

TEST_F(LiveGridMapTest, a_call_draws_a_bounded_number_of_scans) {
  drive(40);
  for (int correction = 0; correction < 10; ++correction) {
    correct(1);
    const std::size_t before = map_.work();
    drive(1);
    EXPECT_EQ(map_.work(), before + 1 + 2 * options_.redrawn_scans) << "the new scan, and moved scans twice";
    expect_equal_to_a_full_drawing();
  }
}

TEST_F(LiveGridMapTest, a_call_in_a_hurry_draws_one_moved_scan) {
  drive(40);
  settle();
  correct(1);
  int asked = 0;
  const std::size_t before = map_.work();
  const auto pose = [this](std::size_t i) { return poses_[i]; };
  map_.update(log_, pose, [&] { return ++asked == 1; });
  EXPECT_EQ(map_.work(), before + 2) << "taken out and drawn";
  EXPECT_EQ(asked, 1);
  map_.update(log_, pose, [&] { return ++asked == 4; });
  EXPECT_EQ(map_.work(), before + 2 + 2 * 3) << "until the work waits";
}

TEST_F(LiveGridMapTest, works_off_the_oldest_debt_first) {
  options_.redrawn_scans = 1;
  map_ = LiveGridMap(options_);
  drive(40);
  settle();
  const std::vector<TPose2D> before = poses_;
  for (TPose2D& pose : poses_) pose.x += 1;
  std::vector<std::size_t> order;
  while (order.size() < 40) {
    update();
    for (std::size_t i = 0; i < 40; ++i)
      if (map_.drawn_pose(i).x != before[i].x && std::count(order.begin(), order.end(), i) == 0)
        order.push_back(i);
  }
  const auto first = std::min_element(order.begin(), order.end());
  std::rotate(order.begin(), first, order.end());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end())) << "each scan has its turn";
}

TEST_F(LiveGridMapTest, scans_that_hardly_moved_stay_as_they_are) {
  drive(50);
  for (TPose2D& pose : poses_) pose = pose + TPose2D(0.01, -0.01, 0.001);
  settle();
  EXPECT_EQ(map_.work(), 50U);
}

TEST_F(LiveGridMapTest, follows_scans_that_the_mapper_changes_or_discards) {
  for (int i = 0; i < 60; ++i) {
    drive(1);
    if (i >= 1 && i % 3 == 0) log_[log_.size() - 2].scan.ranges_m[20] *= 0.9F;  // straightened
    if (i >= 41 && i % 2 == 0) discard_ranges(log_[log_.size() - 42]);
  }
  update();
  expect_equal_to_a_full_drawing();
  EXPECT_FALSE(has_ranges(log_[1]));
  correct(0.5);
  settle();
  expect_equal_to_a_full_drawing();
}

TEST_F(LiveGridMapTest, leaves_scans_out_once_most_are_superseded) {
  for (std::size_t i = 0; i < 180; ++i) all_.push_back(all_[i]), poses_.push_back(poses_[i]);
  drive(240);
  settle();
  for (std::size_t i = 0; i < 100; ++i) discard_ranges(log_[i]);
  settle();
  EXPECT_EQ(map_.work(), 240U) << "superseded scans stay in the map";
  for (std::size_t i = 100; i <= 120; ++i) discard_ranges(log_[i]);
  update();
  EXPECT_FALSE(map_.is_complete()) << "now they are most of all";
  correct(0.5);
  settle();
  EXPECT_TRUE(map_.is_complete());
  expect_equal_to_a_full_drawing();
}

TEST_F(LiveGridMapTest, a_map_that_grows_too_large_gets_coarser_cells) {
  options_.map.max_cells = 10'000;
  map_ = LiveGridMap(options_);
  drive(30);
  settle();
  expect_equal_to_a_full_drawing();
  const std::size_t before = map_.work();
  update();
  EXPECT_EQ(map_.work(), before);
  for (std::size_t i = 30; i < poses_.size(); ++i) poses_[i].x += 60;
  drive(1);
  EXPECT_FALSE(map_.is_complete());
  drive(29);
  settle();
  EXPECT_TRUE(map_.is_complete());
  expect_equal_to_a_full_drawing();
  EXPECT_GT(map_.snapshot().layout.resolution_m, 0.1);
}

TEST_F(LiveGridMapTest, a_snapshot_never_changes) {
  drive(20);
  const GridSnapshot early = map_.snapshot();
  const auto expected = grid_of(early)->getRawMap();
  drive(40);
  correct(0.7);
  settle();
  EXPECT_EQ(grid_of(early)->getRawMap(), expected);
}

TEST_F(LiveGridMapTest, an_updated_grid_equals_a_new_one) {
  poses_[0] = {-30, -30, 0};  // two scans far away that fix the extent
  poses_[1] = {30, 30, 0};
  drive(60);
  GridSnapshot before = map_.snapshot();
  const auto grid = grid_of(before);
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 2; k < poses_.size(); ++k) poses_[k].x += i % 10 == 0 ? 1.7 : 0;
    update();
    GridSnapshot now = map_.snapshot();
    ASSERT_TRUE(update_grid(before, now, *grid));
    ASSERT_EQ(grid->getRawMap(), grid_of(now)->getRawMap());
    before = std::move(now);
  }
  GridSnapshot other = before;
  ++other.layout.width;
  EXPECT_FALSE(update_grid(before, other, *grid));
}

TEST(GridTilesTest, removing_frames_in_any_order_leaves_the_others) {
  const MappingResult walk = walk_around_the_room(30);
  FrameCellFinder finder({}, 0.05);
  GridTiles some;
  GridTiles others;
  const auto cells = [&](std::size_t i) { return finder.find(walk.log[i], walk.frames[i].map_T_robot); };
  for (std::size_t i = 0; i < 30; ++i) some.add(cells(i));
  for (const std::size_t i : {29U, 3U, 17U}) some.remove(cells(i));
  for (std::size_t i = 0; i < 29; ++i)
    if (i != 3 && i != 17) others.add(cells(i));
  const GridLayout layout = layout_for({{-5, -5, 0}, {5, 5, 0}}, {});
  EXPECT_EQ(grid_of(some.snapshot(layout))->getRawMap(), grid_of(others.snapshot(layout))->getRawMap());
  for (std::size_t i = 0; i < 29; ++i)
    if (i != 3 && i != 17) some.remove(cells(i));
  EXPECT_TRUE(some.snapshot(layout).tiles.empty()) << "empty tiles are freed";
}

}  // namespace
}  // namespace psi_slam
