// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/unplaced_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "local_maps/simulated_drive.h"
#include "psi_slam/mapper.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A run twice around the corridor of the office, so that every place of the second round is mapped before.
SimulatedDrive two_rounds() {
  return drive_along(office_floor(),
                     path_along({{1.6, 1.6},
                                 {18.3, 1.6},
                                 {18.3, 12.4},
                                 {1.6, 12.4},
                                 {1.6, 1.6},
                                 {18.3, 1.6},
                                 {18.3, 12.4},
                                 {1.6, 12.4}},
                                0.16, 0.12),
                     {}, 11);
}

/// Removes the scans [begin, end). The scans from `end` on come 60 s later, and their odometry continues from
/// the last pose before the gap: the robot was carried without its wheels turning.
void carry(SimulatedDrive& drive, std::size_t begin, std::size_t end) {
  const TPose2D odom_T_begin = drive.frames[begin - 1].odom_T_robot;
  const TPose2D odom_T_end = drive.frames[end].odom_T_robot;
  const TimeUs passed_us = drive.frames[end].time_us - drive.frames[begin - 1].time_us;
  for (std::size_t i = end; i < drive.frames.size(); ++i) {
    drive.frames[i].odom_T_robot = odom_T_begin + (drive.frames[i].odom_T_robot - odom_T_end);
    drive.frames[i].time_us += 60'000'000 - passed_us;
  }
  const auto cut = [&](auto& items) {
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin),
                items.begin() + static_cast<std::ptrdiff_t>(end));
  };
  cut(drive.frames);
  cut(drive.map_T_robot);
}

/// Returns the first scan of the second round that is farther along the path than `travel_m`.
std::size_t scan_after(const SimulatedDrive& drive, double travel_m) {
  double sum_m = 0;
  std::size_t i = 1;
  for (; i < drive.map_T_robot.size() && sum_m < travel_m; ++i)
    sum_m += std::hypot(drive.map_T_robot[i].x - drive.map_T_robot[i - 1].x,
                        drive.map_T_robot[i].y - drive.map_T_robot[i - 1].y);
  return i;
}

MappingResult map_of(const std::vector<Frame>& frames) {
  Mapper mapper;
  for (const Frame& frame : frames) mapper.add(frame);
  return mapper.finish();
}

double largest_error_m(const MappingResult& result, const SimulatedDrive& drive, std::size_t begin,
                       std::size_t end, std::size_t reference) {
  double largest_m = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const TPose2D found = result.frames[i].map_T_robot - result.frames[reference].map_T_robot;
    const TPose2D truth = drive.map_T_robot[i] - drive.map_T_robot[reference];
    largest_m = std::max(largest_m, std::hypot(found.x - truth.x, found.y - truth.y));
  }
  return largest_m;
}

TEST(UnplacedRuns, a_robot_that_was_carried_is_found_again) {
  SimulatedDrive drive = two_rounds();
  const std::size_t begin = scan_after(drive, 40);
  carry(drive, begin, scan_after(drive, 60));
  const MappingResult result = map_of(drive.frames);
  ASSERT_EQ(result.interruptions.size(), 1U);
  EXPECT_EQ(result.interruptions[0].frame, begin);
  ASSERT_TRUE(result.interruptions[0].found_frame);
  EXPECT_GT(*result.interruptions[0].found_frame, begin);
  EXPECT_LT(largest_error_m(result, drive, 0, drive.frames.size(), 0), 0.15);
}

TEST(UnplacedRuns, a_robot_that_is_never_found_again_has_a_map_of_its_own) {
  SimulatedDrive drive = two_rounds();
  drive.frames.resize(scan_after(drive, 30));
  const std::size_t begin = drive.frames.size();
  SimulatedWalls hall;
  hall.add_wall(0, 0, 9, 0);
  hall.add_wall(9, 0, 11, 7);
  hall.add_wall(11, 7, 0, 8);
  hall.add_wall(0, 8, 0, 0);
  hall.add_wall(3, 3, 4, 5);
  SimulatedDrive elsewhere =
      drive_along(hall, path_along({{1.5, 1.5}, {8, 1.5}, {8.5, 6}, {2, 6.5}}), {}, 12);
  const TimeUs later_us = drive.frames.back().time_us + 60'000'000 - elsewhere.frames.front().time_us;
  const TPose2D odom_T_odom = drive.frames.back().odom_T_robot - elsewhere.frames.front().odom_T_robot;
  drive.map_T_robot.resize(begin);
  for (Frame frame : elsewhere.frames) {
    frame.time_us += later_us;
    frame.odom_T_robot = odom_T_odom + frame.odom_T_robot;
    drive.frames.push_back(frame);
  }
  for (const TPose2D& pose : elsewhere.map_T_robot) drive.map_T_robot.push_back(pose);
  const MappingResult result = map_of(drive.frames);
  ASSERT_EQ(result.interruptions.size(), 1U);
  EXPECT_EQ(result.interruptions[0].frame, begin);
  EXPECT_FALSE(result.interruptions[0].found_frame);
  EXPECT_LT(largest_error_m(result, drive, 0, begin, 0), 0.1);
  EXPECT_LT(largest_error_m(result, drive, begin, drive.frames.size(), begin), 0.1);
  double x_max = 0;
  for (std::size_t i = 0; i < begin; ++i) x_max = std::max(x_max, result.frames[i].map_T_robot.x);
  for (std::size_t i = begin; i < result.frames.size(); ++i)
    EXPECT_GT(result.frames[i].map_T_robot.x, x_max + 2) << "scan " << i;
}

// The robot stands still while it is switched off, and its odometry begins again at zero.
TEST(UnplacedRuns, a_restart_of_odometry_is_no_interruption) {
  SimulatedDrive drive = two_rounds();
  const std::size_t half = drive.frames.size() / 2;
  const TPose2D odom_T_half = drive.frames[half].odom_T_robot;
  for (std::size_t i = half; i < drive.frames.size(); ++i) {
    drive.frames[i].odom_T_robot = drive.frames[i].odom_T_robot - odom_T_half;
    drive.frames[i].time_us += 30'000'000;
  }
  const MappingResult result = map_of(drive.frames);
  EXPECT_TRUE(result.interruptions.empty());
  EXPECT_LT(largest_error_m(result, drive, 0, drive.frames.size(), 0), 0.1);
}

/// Four nodes, of which the last two are an unplaced run.
struct MapAndRun {
  PoseGraph graph;
  KeyframeStore keyframes;

  MapAndRun() {
    for (const TPose2D& pose : {TPose2D(0, 0, 0), TPose2D(1, 0, 0), TPose2D(60, 0, 0), TPose2D(61, 0, 0)}) {
      graph.add_node(pose);
      NodeScan scan;
      auto points = std::make_shared<ScanPoints>();
      points->farthest_m = 3;
      scan.points = points;
      keyframes.nodes.push_back(scan);
    }
    keyframes.unplaced.push_back(run());
  }

  static UnplacedRun run() {
    UnplacedRun run;
    run.begin = 2;
    return run;
  }

  void add_loop(std::size_t from, std::size_t to, const TPose2D& from_T_to) {
    Constraint loop;
    loop.kind = Constraint::Kind::kLoop;
    loop.from = from;
    loop.to = to;
    loop.from_T_to = from_T_to;
    loop.information.setIdentity();
    graph.add_constraint(loop);
  }
};

TEST(UnplacedRuns, are_moved_to_the_place_that_a_loop_finds) {
  for (const bool is_from_map : {true, false}) {
    MapAndRun maps;
    maps.add_loop(2, 3, {1, 0, 0});
    EXPECT_FALSE(place_joined_run(0, maps.keyframes, maps.graph)) << "the loop is within the run";
    const TPose2D map_T_run{0, 2, M_PI / 2};
    is_from_map ? maps.add_loop(1, 3, map_T_run) : maps.add_loop(3, 1, TPose2D(0, 0, 0) - map_T_run);
    EXPECT_FALSE(place_joined_run(2, maps.keyframes, maps.graph)) << "there is no new loop";
    EXPECT_TRUE(place_joined_run(1, maps.keyframes, maps.graph));
    EXPECT_TRUE(maps.keyframes.unplaced.empty());
    EXPECT_NEAR(maps.graph.pose(3).x, 1, 1e-9);
    EXPECT_NEAR(maps.graph.pose(3).y, 2, 1e-9);
    EXPECT_NEAR(maps.graph.pose(2).y, 1, 1e-9) << "the run moved as a rigid body";
    EXPECT_EQ(maps.graph.pose(1), TPose2D(1, 0, 0));
  }
}

TEST(UnplacedRuns, an_earlier_run_is_not_moved_by_loops_of_later_nodes) {
  MapAndRun maps;
  maps.keyframes.unplaced.front().end = 3;
  maps.add_loop(1, 3, {0, 2, 0});
  EXPECT_FALSE(place_joined_run(0, maps.keyframes, maps.graph));
  EXPECT_EQ(maps.graph.pose(2), TPose2D(60, 0, 0));
}

TEST(UnplacedRuns, are_joined_by_enabled_loops_only) {
  MapAndRun maps;
  EXPECT_EQ(unjoined_runs({MapAndRun::run()}, maps.graph).size(), 1U);
  maps.add_loop(1, 3, {0, 2, 0});
  EXPECT_TRUE(unjoined_runs({MapAndRun::run()}, maps.graph).empty());
  maps.graph.set_enabled(0, false);
  EXPECT_EQ(unjoined_runs({MapAndRun::run()}, maps.graph).size(), 1U);
}

TEST(UnplacedRuns, are_laid_right_beside_the_map) {
  MapAndRun maps;
  lay_aside({MapAndRun::run()}, maps.keyframes, maps.graph);
  EXPECT_NEAR(maps.graph.pose(2).x, 1 + 3 + 2 + 3, 1e-9) << "both scans reach 3 m, and 2 m are left between";
  EXPECT_NEAR(maps.graph.pose(2).y, 0, 1e-9);
  EXPECT_NEAR(maps.graph.pose(3).x - maps.graph.pose(2).x, 1, 1e-9);
}

}  // namespace
}  // namespace psi_slam
