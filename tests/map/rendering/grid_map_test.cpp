// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/grid_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "simulated_room.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool is_free(const COccupancyGridMap2D& grid, double x, double y) {
  return grid.getPos(static_cast<float>(x), static_cast<float>(y)) > 0.75F;
}
bool is_wall(const COccupancyGridMap2D& grid, double x, double y) {
  return grid.getPos(static_cast<float>(x), static_cast<float>(y)) < 0.25F;
}
bool is_unknown(const COccupancyGridMap2D& grid, double x, double y) {
  return std::abs(grid.getPos(static_cast<float>(x), static_cast<float>(y)) - 0.5F) < 0.01F;
}

TEST(GridMap, a_room_is_free_inside_its_walls_and_unknown_outside) {
  const SimulatedRoom room{-2.02, 4.03, -1.02, 3.03};
  const BeamBearings all_around = even_bearings(-M_PI, M_PI, 1441);
  const std::vector<TPose2D> poses = {{0.5, 0.5, 0}, {2.5, 1.5, 1}, {-1, 2, -2}};
  std::vector<Frame> log;
  for (const TPose2D& pose : poses) log.push_back(room.scan_from(pose, all_around));
  const auto grid = draw_grid_map(log, poses);
  for (double x = -1.975; x < 4; x += 0.05) {
    EXPECT_TRUE(is_wall(*grid, x, -1.02)) << x;
    EXPECT_TRUE(is_wall(*grid, x, 3.03)) << x;
    EXPECT_TRUE(is_unknown(*grid, x, 3.23)) << x;
    for (double y = -0.975; y < 3; y += 0.05) EXPECT_TRUE(is_free(*grid, x, y)) << x << ' ' << y;
  }
  for (double y = -0.975; y < 3; y += 0.05) {
    EXPECT_TRUE(is_wall(*grid, -2.02, y)) << y;
    EXPECT_TRUE(is_wall(*grid, 4.03, y)) << y;
  }
  EXPECT_NEAR(static_cast<double>(grid->getXMin()), -2.55, 0.051) << "the margin is half a metre";
  EXPECT_NEAR(static_cast<double>(grid->getYMax()), 3.55, 0.051);
}

TEST(GridMap, beams_follow_their_own_bearings) {
  const auto bearings =
      std::make_shared<const std::vector<float>>(std::vector<float>{-1.2F, 0.1F, 0.2F, 1.5F});
  Frame frame;
  frame.scan.bearings_rad = bearings;
  frame.scan.ranges_m = std::vector<float>{4, 5, 6, 7};
  frame.scan.max_range_m = 30;
  frame.scan.robot_T_laser = {0.3, -0.2, 0.5};
  const TPose2D pose(10, -20, 2.5);
  const auto grid = draw_grid_map({frame}, {pose});
  const TPose2D laser = pose + frame.scan.robot_T_laser;
  for (std::size_t i = 0; i < bearings->size(); ++i) {
    const double angle = laser.phi + static_cast<double>((*bearings)[i]);
    const auto range = static_cast<double>(frame.scan.ranges_m[i]);
    EXPECT_TRUE(is_wall(*grid, laser.x + range * std::cos(angle), laser.y + range * std::sin(angle))) << i;
    EXPECT_TRUE(is_free(*grid, laser.x + range / 2 * std::cos(angle), laser.y + range / 2 * std::sin(angle)))
        << i;
  }
}

TEST(GridMap, rays_follow_the_true_line) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> angle(-3.1F, 3.1F);
  std::uniform_real_distribution<float> range(0.2F, 5);
  for (int trial = 0; trial < 100; ++trial) {
    Frame frame;
    frame.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::vector<float>{angle(random)});
    const bool no_return = trial % 2 == 0;
    frame.scan.ranges_m = {no_return ? kInfinity : range(random)};
    frame.scan.max_range_m = 30;
    const auto grid = draw_grid_map({frame}, {{0.013, -0.021, 0}}, {0.1, 30, 3, 0.5, 1'000'000});
    const auto bearing = static_cast<double>(frame.scan.bearings_rad->front());
    const double length = no_return ? 3 : static_cast<double>(frame.scan.ranges_m[0]);
    int free_cells = 0;
    for (unsigned y = 0; y < grid->getSizeY(); ++y) {
      for (unsigned x = 0; x < grid->getSizeX(); ++x) {
        if (grid->getCell(static_cast<int>(x), static_cast<int>(y)) < 0.75F) continue;
        ++free_cells;
        const double dx = static_cast<double>(grid->idx2x(x)) - 0.013;
        const double dy = static_cast<double>(grid->idx2y(y)) + 0.021;
        EXPECT_LT(std::abs(-std::sin(bearing) * dx + std::cos(bearing) * dy), 0.051)
            << "no free cell is beside the line";
        EXPECT_LT(std::cos(bearing) * dx + std::sin(bearing) * dy, length + 0.051)
            << "no free cell is beyond the end of the line";
      }
    }
    const double steps = length * std::max(std::abs(std::cos(bearing)), std::abs(std::sin(bearing))) / 0.1;
    EXPECT_NEAR(free_cells, steps, 1.5) << "one free cell for each step along the longer axis";
  }
}

TEST(GridMap, ignores_invalid_readings_and_draws_long_beams_as_free_space) {
  Frame frame;
  frame.scan.bearings_rad = even_bearings(0, M_PI / 2, 2);
  frame.scan.ranges_m = std::vector<float>{kNan, 20};
  const auto grid = draw_grid_map({frame}, {{0.01, 0.01, 0}}, {0.05, 10, 0, 0.5, 1'000'000});
  EXPECT_TRUE(is_unknown(*grid, 0.31, 0.01));
  EXPECT_TRUE(is_free(*grid, 0.01, 9.9));
  EXPECT_LT(grid->getYMax(), 11);
  for (double y = 0.1; y < 10.5; y += 0.05) EXPECT_FALSE(is_wall(*grid, 0.01, y));
}

TEST(GridMap, a_misplaced_scan_draws_nothing) {
  const SimulatedRoom room{-2.02, 4.03, -1.02, 3.03};
  const TPose2D pose(0.5, 0.5, 0);
  const Frame frame = room.scan_from(pose, even_bearings(-M_PI, M_PI, 721));
  Frame misplaced = frame;
  misplaced.is_misplaced = true;
  const TPose2D wrong(0.5, 0.5, 0.4);
  const auto with = draw_grid_map({frame, misplaced}, {pose, wrong});
  const auto without = draw_grid_map({frame}, {pose});
  EXPECT_EQ(with->getRawMap(), without->getRawMap());
}

TEST(GridMap, beams_without_return_free_the_unknown_cells_on_their_way_and_no_others) {
  // The last two scans have no returns. They only give all maps the same size.
  const std::vector<TPose2D> poses = {
      {0.01, 0.02, 0}, {1.3, -0.7, 2}, {-0.4, 1.1, -1}, {-6, -6, 0}, {6, 6, 0}};
  const auto draw = [&](const std::vector<Frame>& log, double max_range_m, double no_return_clears_m) {
    return draw_grid_map(log, poses, {0.05, max_range_m, no_return_clears_m, 0.5, 1'000'000, true, 1})
        ->getRawMap();
  };
  std::mt19937_64 random(9);
  std::uniform_real_distribution<float> near(0.2F, 3.9F);
  std::vector<Frame> log(poses.size());
  // Holds the beams without return, as returns at 20 m, beyond the range of the map.
  std::vector<Frame> only_no_returns(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    log[i].scan.bearings_rad = even_bearings(-M_PI, M_PI, 90);
    log[i].scan.max_range_m = 30;
    only_no_returns[i] = log[i];
    for (int beam = 0; beam < 90; ++beam) {
      const std::array<float, 3> readings{near(random), kInfinity, kNan};
      const float range = i < 3 ? readings[random() % 3] : kNan;
      log[i].scan.ranges_m.push_back(range);
      only_no_returns[i].scan.ranges_m.push_back(range > 4 ? 20 : kNan);
    }
  }
  auto expected = draw(log, 4, 0);
  const auto passed = draw(only_no_returns, 4, 0);
  ASSERT_EQ(passed.size(), expected.size());
  std::size_t cleared = 0;
  for (std::size_t cell = 0; cell < expected.size(); ++cell) {
    if (expected[cell] != 0 || passed[cell] == 0) continue;
    expected[cell] = 24;  // log-odds of one pass, in MRPT's units
    ++cleared;
  }
  EXPECT_GT(cleared, 500U);
  EXPECT_EQ(draw(log, 4, 10), expected) << "beams without return clear nothing beyond the range of the map";
  for (Frame& frame : log) frame.scan.max_range_m = 4;
  EXPECT_EQ(draw(log, 4, 30), expected)
      << "beams without return clear nothing beyond the range of the sensor";
}

TEST(GridMap, a_length_of_0_ignores_beams_without_return) {
  Frame frame;
  frame.scan.bearings_rad = even_bearings(0, M_PI / 2, 2);
  frame.scan.max_range_m = 30;
  const auto drawn = [&](float second_m) {
    frame.scan.ranges_m = {3, second_m};
    return draw_grid_map({frame}, {{0.01, 0.01, 0}}, {0.05, 30, 0, 0.5, 1'000'000})->getRawMap();
  };
  EXPECT_EQ(drawn(kInfinity), drawn(kNan));
}

TEST(GridMap, a_wall_remains_if_few_scans_pass_through_it) {
  Frame hit;
  hit.scan.bearings_rad = even_bearings(0, 0.5, 2);
  hit.scan.ranges_m = std::vector<float>{1, 1};
  Frame pass = hit;
  pass.scan.ranges_m = std::vector<float>{2, 2};
  const auto drawn = [&](int hits, int passes) {
    std::vector<Frame> log(static_cast<std::size_t>(hits), hit);
    log.insert(log.end(), static_cast<std::size_t>(passes), pass);
    return draw_grid_map(log, std::vector<TPose2D>(log.size(), {0.01, 0.01, 0}));
  };
  EXPECT_TRUE(is_wall(*drawn(10, 25), 1.01, 0.01));
  EXPECT_TRUE(is_free(*drawn(10, 35), 1.01, 0.01));
}

TEST(GridMap, the_order_of_the_scans_does_not_matter) {
  const MappingResult result = walk_around_the_room();
  std::vector<TPose2D> poses;
  for (const FrameRecord& frame : result.frames) poses.push_back(frame.map_T_robot);
  auto log = result.log;
  const auto grid = draw_grid_map(log, poses);
  std::reverse(log.begin(), log.end());
  std::reverse(poses.begin(), poses.end());
  EXPECT_EQ(draw_grid_map(log, poses)->getRawMap(), grid->getRawMap());
}

TEST(GridMap, more_scans_than_the_counter_holds_do_not_matter) {
  Frame frame;
  frame.scan.bearings_rad = even_bearings(0, 0.5, 2);
  frame.scan.ranges_m = std::vector<float>{0.2F, 0.2F};
  const std::vector<Frame> log(70'000, frame);
  const auto grid = draw_grid_map(log, std::vector<TPose2D>(log.size(), {0.01, 0.01, 0}));
  EXPECT_TRUE(is_wall(*grid, 0.21, 0.01));
  EXPECT_TRUE(is_free(*grid, 0.1, 0.01));
}

TEST(GridMap, a_huge_site_gets_a_coarser_map) {
  Frame frame;
  frame.scan.bearings_rad = even_bearings(0, 0.5, 2);
  frame.scan.ranges_m = std::vector<float>{1, 1};
  const auto grid = draw_grid_map({frame, frame}, {{0, 0, 0}, {100, 100, 0}}, {0.05, 30, 5, 0.5, 1'000'000});
  EXPECT_FLOAT_EQ(grid->getResolution(), 0.2F);
  EXPECT_LE(grid->getSizeX() * grid->getSizeY(), 1'000'000U);
}

TEST(GridMap, draws_an_empty_log_and_rejects_wrong_input) {
  EXPECT_GT(draw_grid_map({}, {})->getSizeX(), 0U);
  EXPECT_THROW(draw_grid_map({Frame()}, {}), std::invalid_argument);
  EXPECT_THROW(draw_grid_map({}, {}, {0, 30, 5, 0.5, 1000}), std::invalid_argument);
  EXPECT_THROW(draw_grid_map({}, {}, {0.05, 30, -1, 0.5, 1000}), std::invalid_argument);
  EXPECT_THROW(draw_grid_map({Frame()}, {{std::nan(""), 0, 0}}), std::invalid_argument);
}

TEST(GridMap, a_single_beam_past_an_edge_draws_nothing_beyond_the_edge) {
  Frame frame;
  frame.scan.bearings_rad = even_bearings(-0.5, 0.5, 101);
  frame.scan.ranges_m.assign(101, 3);
  frame.scan.ranges_m[50] = 8;
  frame.scan.max_range_m = 30;
  const TPose2D pose(0.02, 0.02, 0);
  const auto drawn = [&](int scans, int min_beams) {
    GridMapOptions options;
    options.min_beams = min_beams;
    options.keep_moving = true;
    const std::vector<Frame> log(static_cast<std::size_t>(scans), frame);
    return draw_grid_map(log, std::vector<TPose2D>(log.size(), pose), options);
  };
  const auto clean = drawn(1, 2);
  EXPECT_TRUE(is_free(*clean, 2.5, 0.02));
  EXPECT_TRUE(is_wall(*clean, 3.01, 0.2)) << "neighbouring beams agree";
  EXPECT_TRUE(is_unknown(*clean, 6.02, 0.02));
  EXPECT_TRUE(is_unknown(*clean, 8.02, 0.02));
  for (const auto& [scans, min_beams] : {std::pair(1, 1), std::pair(2, 2), std::pair(3, 3)}) {
    EXPECT_TRUE(is_free(*drawn(scans, min_beams), 6.02, 0.02)) << scans << ' ' << min_beams;
    EXPECT_TRUE(is_wall(*drawn(scans, min_beams), 8.02, 0.02)) << scans << ' ' << min_beams;
  }
}

TEST(GridMap, a_far_wall_with_one_beam_per_cell_stays) {
  const SimulatedRoom room{-1, 25, -4, 4};
  const TPose2D pose(0, 0, 0);
  const auto draw = [&](int min_beams) {
    GridMapOptions options;
    options.min_beams = min_beams;
    return draw_grid_map({room.scan_from(pose, even_bearings(-M_PI / 2, M_PI / 2, 181))}, {pose}, options)
        ->getRawMap();
  };
  EXPECT_EQ(draw(2), draw(1));
}

TEST(GridMap, each_laser_of_a_frame_draws_from_its_own_pose) {
  const auto straight_on = std::make_shared<const std::vector<float>>(std::vector<float>{0.0F});
  Frame frame;
  frame.scan.bearings_rad = straight_on;
  frame.scan.ranges_m = {3};
  frame.scan.max_range_m = 30;
  frame.scan.robot_T_laser = {0.5, 0, 0};
  CompanionScan rear;
  rear.scan = frame.scan;
  rear.scan.laser = 1;
  rear.scan.ranges_m = {4};
  rear.scan.robot_T_laser = {-0.5, 0, M_PI};
  rear.frame_T_robot = {0, 1, 0};  // the robot moved to its left between the two scans
  frame.companions = {rear};
  const TPose2D pose(10.02, -20.02, 0);
  const auto grid = draw_grid_map({frame}, {pose});
  EXPECT_TRUE(is_wall(*grid, pose.x + 3.5, pose.y));
  EXPECT_TRUE(is_wall(*grid, pose.x - 4.5, pose.y + 1)) << "a wall that only the rear laser sees";
  for (double x = 0.6; x < 3.4; x += 0.05) EXPECT_TRUE(is_free(*grid, pose.x + x, pose.y)) << x;
  for (double x = 0.6; x < 4.4; x += 0.05) EXPECT_TRUE(is_free(*grid, pose.x - x, pose.y + 1)) << x;
  for (double x = -0.4; x < 0.4; x += 0.05) {
    EXPECT_TRUE(is_unknown(*grid, pose.x + x, pose.y)) << x;
    EXPECT_TRUE(is_unknown(*grid, pose.x + x, pose.y + 1)) << x;
  }
  EXPECT_LT(static_cast<double>(grid->getXMin()), pose.x - 4.5) << "the map includes what both lasers see";
}

}  // namespace
}  // namespace psi_slam
