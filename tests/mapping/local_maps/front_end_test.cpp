// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/front_end.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "logs/frames/pose_operations.h"
#include "simulated_drive.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Outcome {
  std::vector<FrontEndStep> steps;
  std::vector<PlacedLocalMap> maps;  // all local maps, in the order in which they were finished
};

Outcome follow(const SimulatedDrive& drive, const FrontEndOptions& options = {}, bool draws_beside = false) {
  FrontEnd front_end(options, draws_beside);
  Outcome result;
  for (const Frame& frame : drive.frames) {
    result.steps.push_back(front_end.add(frame));
    for (const PlacedLocalMap& finished : result.steps.back().finished) result.maps.push_back(finished);
  }
  for (const PlacedLocalMap& last : front_end.finish()) result.maps.push_back(last);
  return result;
}

struct PoseErrors {
  double largest_m = 0;
  double largest_rad = 0;
};

PoseErrors errors_of(const std::vector<TPose2D>& poses, const std::vector<TPose2D>& truth) {
  PoseErrors errors;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    errors.largest_m =
        std::max(errors.largest_m, std::hypot(poses[i].x - truth[i].x, poses[i].y - truth[i].y));
    errors.largest_rad =
        std::max(errors.largest_rad, std::abs(mrpt::math::wrapToPi(poses[i].phi - truth[i].phi)));
  }
  return errors;
}

PoseErrors errors_of(const Outcome& outcome, const SimulatedDrive& drive) {
  std::vector<TPose2D> poses;
  for (const FrontEndStep& step : outcome.steps) poses.push_back(step.local_T_robot);
  return errors_of(poses, drive.map_T_robot);
}

PoseErrors errors_of_odometry(const SimulatedDrive& drive) {
  std::vector<TPose2D> poses;
  for (const Frame& frame : drive.frames) poses.push_back(frame.odom_T_robot);
  return errors_of(poses, drive.map_T_robot);
}

TEST(FrontEnd, follows_a_robot_round_a_building_with_noisy_odometry) {
  OdometryErrors errors;
  errors.length_factor = 0.94;
  errors.length_share = 0.2;
  errors.turn_factor = 1.1;
  errors.turn_share = 0.3;
  errors.drift_rad_per_m = 0.02;
  const SimulatedDrive drive = drive_along(office_floor(), round_the_office(), errors, 1);
  EXPECT_GT(errors_of_odometry(drive).largest_m, 5) << "odometry alone fails";
  const Outcome outcome = follow(drive);
  const PoseErrors off = errors_of(outcome, drive);
  EXPECT_LT(off.largest_m, 0.25);
  EXPECT_LT(off.largest_rad, 0.03);
  for (std::size_t i = 1; i < outcome.steps.size(); ++i)
    EXPECT_TRUE(outcome.steps[i].matched) << "scan " << i;
}

TEST(FrontEnd, follows_a_robot_whose_scans_are_far_apart) {
  OdometryErrors errors;
  errors.length_share = 0.05;
  errors.turn_share = 0.1;
  const SimulatedDrive drive = drive_along(
      office_floor(), path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}}, 0.9, 0.4),
      errors, 2);
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.3);
  EXPECT_LT(off.largest_rad, 0.04);
}

// A hall of 70 m by 50 m, and a robot that scans once per metre. At distances of 20 to 40 m, the beams hit
// the walls 20 to 60 cm apart. So the hits of each scan fall between the hits of the previous scan.
TEST(FrontEnd, follows_a_robot_through_a_large_hall_with_one_scan_a_metre) {
  SimulatedWalls hall;
  hall.add_box(-35, -25, 35, 25);
  hall.add_box(-10, -2, -8, 2);
  hall.add_box(12, 5, 18, 7);
  OdometryErrors errors;
  errors.length_share = 0.05;
  errors.turn_share = 0.1;
  const SimulatedDrive drive =
      drive_along(hall, path_along({{-20, -15}, {20, -15}, {20, 15}, {-20, 15}}, 1.0, 0.5), errors, 12);
  const Outcome outcome = follow(drive);
  EXPECT_LT(errors_of(outcome, drive).largest_m, 0.2);
  for (std::size_t i = 1; i < outcome.steps.size(); ++i) {
    EXPECT_TRUE(outcome.steps[i].matched) << "scan " << i;
    EXPECT_GT(outcome.steps[i].response, 0.4) << "scan " << i;
  }
}

TEST(FrontEnd, finds_the_robot_again_where_odometry_is_wrong_by_a_whole_step) {
  SimulatedWalls room;
  room.add_box(-3, -6, 25, 7);
  for (double x = -2; x < 24; x += 2.7)  // shelves of different depths on both sides
    room.add_box(x, 5.5 - 0.11 * x, x + 1.1, 7), room.add_box(x + 0.9, -6, x + 1.6, -5 + 0.09 * x);
  SimulatedDrive drive = drive_along(room, path_along({{0, 0}, {20, 0.5}}, 0.9, 0.4), {}, 13);
  TPose2D odom_T_robot = drive.frames.front().odom_T_robot;
  for (std::size_t i = 1; i < drive.frames.size(); ++i) {
    TPose2D motion = drive.map_T_robot[i] - drive.map_T_robot[i - 1];
    // In every eighth step, odometry reports the opposite translation.
    if (i % 8 == 5) motion = {-motion.x, -motion.y, motion.phi};
    odom_T_robot = odom_T_robot + motion;
    drive.frames[i].odom_T_robot = odom_T_robot;
    // The scans are 2 s apart, so the last motion hardly predicts the next one.
    drive.frames[i].time_us = static_cast<TimeUs>(i) * 2'000'000;
  }
  EXPECT_GT(errors_of_odometry(drive).largest_m, 3);
  EXPECT_LT(errors_of(follow(drive), drive).largest_m, 0.3);
  FrontEndOptions narrow;
  narrow.poor_response_share = 0;
  EXPECT_GT(errors_of(follow(drive, narrow), drive).largest_m, 1)
      << "without the wide window, the robot is not found again";
}

// More than half of the beams end at random shorter ranges, as on moving leaves. Some matches do not reach a
// response of 0.25, but the remaining beams to the walls determine the pose.
TEST(FrontEnd, matches_where_only_a_part_of_each_scan_can_match) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 14);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> share(0, 1);
  for (Frame& frame : drive.frames)
    for (float& range_m : frame.scan.ranges_m)
      if (share(random) < 0.55F) range_m *= 0.2F + 0.8F * share(random);
  const Outcome outcome = follow(drive);
  EXPECT_LT(errors_of(outcome, drive).largest_m, 0.3);
  std::size_t low = 0;
  for (std::size_t i = 5; i < outcome.steps.size(); ++i) {  // the expected response is low from here on
    EXPECT_TRUE(outcome.steps[i].matched) << "scan " << i;
    if (outcome.steps[i].response < 0.25) ++low;
  }
  EXPECT_GT(low, 0U);
}

// The robot is carried from an office to a hall, and odometry does not notice.
TEST(FrontEnd, does_not_match_scans_of_another_place) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 15);
  constexpr std::size_t kCarried = 60;
  SimulatedWalls hall;
  hall.add_box(-9, -13, 14, 12);
  hall.add_box(3, 2, 5, 3);
  const SimulatedDrive after = drive_along(hall, path_along({{0, 0}, {8, -3}}, 0.1, 0.1), {}, 16);
  ASSERT_GT(after.frames.size(), 20U);
  const Frame last = drive.frames[kCarried - 1];
  drive.frames.resize(kCarried);
  for (const Frame& frame : after.frames) {
    drive.frames.push_back(frame);
    drive.frames.back().time_us += last.time_us + 100'000;
    drive.frames.back().odom_T_robot =
        last.odom_T_robot + (frame.odom_T_robot - after.frames.front().odom_T_robot);
  }
  const Outcome outcome = follow(drive);
  for (std::size_t i = 1; i < kCarried; ++i) EXPECT_TRUE(outcome.steps[i].matched) << "scan " << i;
  EXPECT_FALSE(outcome.steps[kCarried].matched);
  EXPECT_FALSE(outcome.steps[kCarried + 1].matched);
  EXPECT_TRUE(outcome.steps.back().matched) << "with the local maps of the hall";
}

// Odometry with an encoder that stalls and then catches up.
TEST(FrontEnd, tolerates_odometry_that_stalls_and_jumps) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 3);
  for (std::size_t i = 0; i < drive.frames.size(); ++i)
    if (i % 25 >= 20) drive.frames[i].odom_T_robot = drive.frames[i - i % 25 + 19].odom_T_robot;
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.2);
  EXPECT_LT(off.largest_rad, 0.03);
}

// An obstacle turns the robot by a large angle in each of three scans, while its slipping wheels measure
// straight motion. Then it stands, and turns on the spot by as much as odometry measures.
TEST(FrontEnd, finds_a_robot_that_an_obstacle_turned_while_its_wheels_slipped) {
  for (const double turn_deg : {20, 35, -50}) {
    const double turn_rad = turn_deg * M_PI / 180;
    std::vector<TPose2D> path = path_along({{1.6, 1.6}, {4.2, 1.6}}, 0.1);
    std::vector<TPose2D> odometry;
    for (const TPose2D& pose : path) odometry.push_back(pose - path.front());
    const auto move = [&](const TPose2D& motion, const TPose2D& measured) {
      path.push_back(path.back() + motion);
      odometry.push_back(odometry.back() + measured);
    };
    for (int i = 0; i < 3; ++i) move({0, 0, turn_rad}, {0.2, 0, 0});
    for (int i = 0; i < 5; ++i) move({0, 0, 0}, {0.2, 0, 0});
    for (int i = 0; i < 10; ++i) move({0, 0, 0.2}, {0, 0, 0.2});
    SimulatedDrive drive = drive_along(office_floor(), path, {}, 17);
    for (std::size_t i = 0; i < odometry.size(); ++i) drive.frames[i].odom_T_robot = odometry[i];
    const PoseErrors off = errors_of(follow(drive), drive);
    EXPECT_LT(off.largest_m, 0.05) << turn_deg << " degrees";
    EXPECT_LT(off.largest_rad, 0.03) << turn_deg << " degrees";
  }
}

// A scan without returns contradicts nothing.
TEST(FrontEnd, scans_without_returns_in_the_middle_of_a_run_become_nodes) {
  SimulatedDrive drive = drive_along(office_floor(), path_along({{1.6, 1.6}, {9, 1.6}}, 0.2), {}, 21);
  const std::size_t blind = drive.frames.size() / 2;
  for (std::size_t i = blind; i < blind + 2; ++i)
    for (float& range_m : drive.frames[i].scan.ranges_m) range_m = kNan;
  for (const FrontEndStep& step : follow(drive).steps) EXPECT_TRUE(step.node);
}

// One scan shows another place, as a damaged message does. It must not become part of the local maps.
TEST(FrontEnd, a_scan_that_contradicts_the_local_map_becomes_no_node) {
  SimulatedDrive drive = drive_along(office_floor(), path_along({{1.6, 1.6}, {9, 1.6}}, 0.2), {}, 18);
  SimulatedWalls closet;
  closet.add_box(-0.6, -0.7, 0.8, 0.9);
  const std::size_t foreign = drive.frames.size() / 2;
  drive.frames[foreign].scan = drive_along(closet, {{0, 0, 0.3}}, {}, 19).frames.front().scan;
  const Outcome outcome = follow(drive);
  for (std::size_t i = 1; i < outcome.steps.size(); ++i) {
    EXPECT_EQ(outcome.steps[i].matched, i != foreign) << "scan " << i;
    EXPECT_EQ(outcome.steps[i].node.has_value(), i != foreign) << "scan " << i;
    EXPECT_EQ(outcome.steps[i].misplaced, i == foreign) << "scan " << i;
  }
  EXPECT_LT(errors_of(outcome, drive).largest_m, 0.05);
}

// Odometry stops measuring while the robot drives through a bare stretch of a corridor. The scans show the
// motion before and after the stretch.
TEST(FrontEnd, odometry_that_freezes_does_not_hold_a_moving_robot_back) {
  SimulatedWalls corridor;
  corridor.add_box(-2, -1, 40, 1);
  for (const double x : {1.0, 2.3, 4.1, 6.0, 7.2, 13.0, 14.1, 16.0, 17.3})
    corridor.add_box(x, 0.8, x + 0.4, 1);
  SimulatedDrive drive = drive_along(corridor, path_along({{0, 0}, {18, 0}}, 0.2), {}, 20);
  for (Frame& frame : drive.frames)
    for (float& range_m : frame.scan.ranges_m)
      if (range_m > 3) range_m = kNan;
  for (std::size_t i = 20; i < drive.frames.size(); ++i)
    drive.frames[i].odom_T_robot = drive.frames[19].odom_T_robot;
  EXPECT_LT(errors_of(follow(drive), drive).largest_m, 0.5);
}

// After a reset of the wheel encoders, one increment of odometry is meaningless.
TEST(FrontEnd, tolerates_a_jump_of_odometry) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 4);
  const std::size_t leap = drive.frames.size() / 3;
  for (std::size_t i = leap; i < drive.frames.size(); ++i)
    drive.frames[i].odom_T_robot = TPose2D(50, -20, 1) + drive.frames[i].odom_T_robot;
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.2);
  EXPECT_LT(off.largest_rad, 0.03);
}

TEST(FrontEnd, follows_a_slow_robot_without_any_odometry) {
  const auto path = path_along({{2, 1.5}, {6, 1.6}, {2, 1.4}}, 0.03, 0.03);
  SimulatedDrive drive = drive_along(office_floor(), path, {}, 5);
  for (Frame& frame : drive.frames) frame.odom_T_robot = {7, -3, 0.5};
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.1);
  EXPECT_LT(off.largest_rad, 0.02);
}

TEST(FrontEnd, ignores_poses_of_frames_without_odometry) {
  const auto path = path_along({{2, 1.5}, {6, 1.6}, {2, 1.4}}, 0.03, 0.03);
  SimulatedDrive drive = drive_along(office_floor(), path, {}, 5);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    if (i / 10 % 2 == 0) continue;  // every second block of ten scans has odometry
    drive.frames[i].has_odometry = false;
    drive.frames[i].odom_T_robot = {7, -3, 0.5};
  }
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.1);
  EXPECT_LT(off.largest_rad, 0.02);
}

// The robot turns by 50 degrees while three seconds of scans are missing.
TEST(FrontEnd, finds_the_robot_again_after_a_gap_without_odometry) {
  const auto path = path_along({{2, 1.5}, {6, 1.6}, {6.1, 1.5}, {6, 1.4}, {2, 1.4}}, 0.03, 0.03);
  SimulatedDrive drive = drive_along(office_floor(), path, {}, 5);
  std::size_t begin = 0;
  while (std::abs(drive.map_T_robot[begin].phi) < 0.3) ++begin;
  std::size_t end = begin;
  while (std::abs(drive.map_T_robot[end].phi) < 1.2) ++end;
  ASSERT_LT(end, drive.frames.size());
  const auto cut = [&](auto& items) {
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin),
                items.begin() + static_cast<std::ptrdiff_t>(end));
  };
  const TimeUs gap_us = 3'000'000 - (drive.frames[end].time_us - drive.frames[begin - 1].time_us);
  cut(drive.frames);
  cut(drive.map_T_robot);
  for (Frame& frame : drive.frames) frame.has_odometry = false;
  for (std::size_t i = begin; i < drive.frames.size(); ++i) drive.frames[i].time_us += gap_us;
  const PoseErrors off = errors_of(follow(drive), drive);
  EXPECT_LT(off.largest_m, 0.1);
  EXPECT_LT(off.largest_rad, 0.03);
}

TEST(FrontEnd, a_robot_at_rest_stays_and_adds_no_nodes) {
  const std::vector<TPose2D> path(100, TPose2D(5, 1.5, 0.3));
  const Outcome outcome = follow(drive_along(office_floor(), path, {}, 6));
  EXPECT_EQ(outcome.steps.front().node, 0U);
  for (std::size_t i = 1; i < outcome.steps.size(); ++i) {
    EXPECT_FALSE(outcome.steps[i].node) << "scan " << i;
    EXPECT_LT(std::hypot(outcome.steps[i].local_T_robot.x, outcome.steps[i].local_T_robot.y), 0.01);
  }
  EXPECT_EQ(outcome.maps.size(), 1U);
}

// Along a bare corridor, odometry determines the position. The walls determine the position across the
// corridor and the heading.
TEST(FrontEnd, in_a_bare_corridor_odometry_determines_the_way_along_it) {
  SimulatedWalls corridor;
  corridor.add_wall(-100, 0, 140, 0);
  corridor.add_wall(-100, 2.4, 140, 2.4);
  OdometryErrors errors;
  errors.length_factor = 0.98;
  errors.length_share = 0.05;
  errors.turn_share = 0.2;
  errors.drift_rad_per_m = 0.02;
  const SimulatedDrive drive = drive_along(corridor, path_along({{0, 1.1}, {25, 1.3}}), errors, 7);
  FrontEndOptions options;
  options.prediction_share = 0.8;
  // Far beams at grazing angles hit the walls at separate points, which look like objects that move with the
  // robot. Matches of these points would shorten the path.
  options.scan.max_range_m = 8;
  const Outcome outcome = follow(drive, options);
  double across_m = 0;
  double heading_rad = 0;
  const TPose2D first = path_along({{0, 1.1}, {25, 1.3}}).front();
  for (std::size_t i = 0; i < outcome.steps.size(); ++i) {
    const TPose2D in_corridor = first + outcome.steps[i].local_T_robot;
    const TPose2D truth = first + drive.map_T_robot[i];
    across_m = std::max(across_m, std::abs(in_corridor.y - truth.y));
    heading_rad = std::max(heading_rad, std::abs(mrpt::math::wrapToPi(in_corridor.phi - truth.phi)));
  }
  EXPECT_LT(across_m, 0.3) << "odometry alone is 6 m off";
  EXPECT_LT(heading_rad, 0.02);
  const TPose2D& last = outcome.steps.back().local_T_robot;
  EXPECT_NEAR(last.x, 0.98 * 25, 0.6) << "odometry determines the length of the path";
}

// A person walks ahead of the robot at a constant distance. About eight beams of each scan hit the person at
// 3 m. At 1.5 m, twice as many beams do, more than a tenth of the scan's points.
SimulatedDrive behind_a_person(double ahead_m) {
  SimulatedWalls corridor;
  corridor.add_wall(-100, 0, 140, 0);
  corridor.add_wall(-100, 2.4, 140, 2.4);
  std::vector<TPose2D> path;  // the robot weaves, so beams hit the walls at varying places
  for (double x = 0; x < 25; x += 0.11)
    path.emplace_back(x, 1.2 + 0.2 * std::sin(x), std::atan(0.2 * std::cos(x)));
  SimulatedDrive drive = drive_along(corridor, path, {}, 11);
  const double noise_m[] = {0.004, -0.007, 0.011, -0.002, -0.012, 0.008, 0.001};
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    LaserScan& scan = drive.frames[i].scan;
    for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
      constexpr double kRadius_m = 0.2;
      const auto bearing = static_cast<double>((*scan.bearings_rad)[k]);
      const double aside_m = ahead_m * std::sin(bearing);
      if (std::cos(bearing) <= 0 || std::abs(aside_m) >= kRadius_m) continue;
      scan.ranges_m[k] =
          static_cast<float>(ahead_m * std::cos(bearing) -
                             std::sqrt(kRadius_m * kRadius_m - aside_m * aside_m) + noise_m[(i + k) % 7]);
    }
  }
  return drive;
}

TEST(FrontEnd, a_person_who_walks_ahead_along_a_bare_corridor_does_not_hold_the_robot_back) {
  for (const double ahead_m : {3.0, 1.5}) {
    const SimulatedDrive drive = behind_a_person(ahead_m);
    FrontEndOptions options;
    options.scan.max_range_m = 8;  // leaves out far beams at grazing angles
    const double let_pass_m =
        25 * options.doubtful_corrections.max_sum_m / options.doubtful_corrections.travel_m;
    EXPECT_LT(errors_of(follow(drive, options), drive).largest_m, let_pass_m) << "error over a path of 25 m";
    options.held_share = 1;
    options.doubtful_corrections = {1000, 100, 1};
    EXPECT_GT(errors_of(follow(drive, options), drive).largest_m, 4)
        << "without the limit, the mapped path is too short";
  }
}

// Without returns, the covariance is that of odometry. It must not depend on the rate of scans.
TEST(FrontEnd, the_same_way_is_as_uncertain_at_every_rate_of_scans) {
  const auto covariance_after = [](int scans) {
    FrontEndOptions options;
    options.max_unmatched_travel_m = 100;
    FrontEnd front_end(options);
    Eigen::Matrix3d last = Eigen::Matrix3d::Zero();
    for (int i = 0; i <= scans; ++i) {
      const double share = static_cast<double>(i) / scans;  // share of a path of 10 m in 20 s
      Frame frame;
      frame.index = static_cast<std::size_t>(i);
      frame.time_us = static_cast<TimeUs>(20'000'000 * share);
      frame.odom_T_robot = {10 * share, 0, 0};
      frame.scan.bearings_rad = even_bearings(-1, 1, 3);
      frame.scan.ranges_m.assign(3, kNan);
      front_end.add(frame);
      if (!front_end.active().empty()) last = front_end.active().front().covariance;
    }
    return last;
  };
  const Eigen::Matrix3d slow = covariance_after(200);
  const Eigen::Matrix3d fast = covariance_after(800);
  EXPECT_GT(slow.trace(), 0);
  EXPECT_NEAR((fast - slow).norm(), 0, 0.15 * slow.norm());
}

TEST(FrontEnd, scans_without_returns_are_placed_by_odometry) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 8);
  drive.frames.resize(120);
  drive.map_T_robot.resize(120);
  for (std::size_t i = 50; i < 60; ++i)
    std::fill(drive.frames[i].scan.ranges_m.begin(), drive.frames[i].scan.ranges_m.end(), kNan);
  const Outcome outcome = follow(drive);
  for (std::size_t i = 50; i < 60; ++i) {
    EXPECT_FALSE(outcome.steps[i].matched);
    EXPECT_EQ(outcome.steps[i].response, 0);
    EXPECT_TRUE(outcome.steps[i].points->points.empty());
  }
  EXPECT_LT(errors_of(outcome, drive).largest_m, 0.1);
}

TEST(FrontEnd, a_log_of_empty_scans_is_dead_reckoning) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 9);
  for (Frame& frame : drive.frames) frame.scan.ranges_m.assign(181, kNan);
  const Outcome outcome = follow(drive);
  const PoseErrors off = errors_of(outcome, drive);
  EXPECT_LT(off.largest_m, 1e-6) << "this odometry is exact";
  EXPECT_LT(off.largest_rad, 1e-6);
  EXPECT_GT(outcome.maps.size(), 1U);
}

TEST(FrontEnd, starts_with_a_scan_that_sees_nothing) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 10);
  drive.frames.resize(100);
  drive.map_T_robot.resize(100);
  drive.frames[0].scan.ranges_m.assign(181, kNan);
  EXPECT_LT(errors_of(follow(drive), drive).largest_m, 0.1);
}

TEST(FrontEnd, no_frames_give_no_local_maps) {
  FrontEnd front_end{FrontEndOptions{}};
  EXPECT_TRUE(front_end.finish().empty());
}

TEST(FrontEnd, every_step_reports_its_result) {
  FrontEndOptions options;
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 11);
  drive.frames.resize(100);
  const Outcome outcome = follow(drive, options);
  EXPECT_FALSE(outcome.steps[0].matched) << "there is no local map yet";
  EXPECT_EQ(outcome.steps[0].local_T_robot, TPose2D(0, 0, 0))
      << "the first scan is the origin of the local frame";
  std::size_t nodes = 0;
  TPose2D last_node;
  for (std::size_t i = 0; i < outcome.steps.size(); ++i) {
    const FrontEndStep& step = outcome.steps[i];
    if (i > 0) {
      EXPECT_TRUE(step.matched);
      EXPECT_GT(step.response, 0);
      EXPECT_LE(step.response, 1);
      EXPECT_GT(step.evaluations, 0);
      EXPECT_GT(step.information(0, 0), 0);
      EXPECT_GT(step.window.x_m, 0);
      EXPECT_LE(step.window.x_m, options.max_window_m);
      EXPECT_LE(step.window.theta_rad, options.max_window_rad);
    }
    EXPECT_FALSE(step.points->points.empty());
    const TPose2D motion = step.local_T_robot - last_node;
    const bool moved = std::hypot(motion.x, motion.y) >= options.node_distance_m ||
                       std::abs(mrpt::math::wrapToPi(motion.phi)) >= options.node_rotation_rad;
    EXPECT_EQ(step.node.has_value(), i == 0 || moved) << "scan " << i;
    if (!step.node) {
      EXPECT_TRUE(step.memberships.empty());
      EXPECT_TRUE(step.finished.empty());
      continue;
    }
    EXPECT_EQ(*step.node, nodes++);
    last_node = step.local_T_robot;
  }
  EXPECT_GT(nodes, 20U);
}

TEST(FrontEnd, local_maps_overlap_by_half_and_two_at_most_are_active) {
  FrontEndOptions options;
  options.nodes_per_local_map = 30;
  options.local_map_travel_m = 1000;
  const SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 12);
  const Outcome outcome = follow(drive, options);

  std::vector<TPose2D> node_poses;
  for (const FrontEndStep& step : outcome.steps)
    if (step.node) node_poses.push_back(step.local_T_robot);

  ASSERT_GT(outcome.maps.size(), 6U);
  for (std::size_t i = 0; i < outcome.maps.size(); ++i) {
    const PlacedLocalMap& map = outcome.maps[i];
    EXPECT_EQ(map.id, i) << "maps end in the order of creation";
    EXPECT_EQ(map.anchor, map.first_node);
    EXPECT_EQ(map.local_T_map, node_poses.at(map.anchor)) << "the anchor's pose is the map's frame";
    EXPECT_TRUE(map.map->finished());
    EXPECT_TRUE(map.map->scores().has_pyramid());
    if (i + 2 < outcome.maps.size()) {
      EXPECT_EQ(map.last_node - map.first_node, 30U);
    }
    if (i > 0) {
      EXPECT_EQ(map.first_node, outcome.maps[i - 1].first_node + 15) << "begins at half of the map before";
    }
    double travelled_m = 0;
    for (std::size_t node = map.first_node + 1; node <= map.last_node; ++node)
      travelled_m += std::hypot(node_poses[node].x - node_poses[node - 1].x,
                                node_poses[node].y - node_poses[node - 1].y);
    EXPECT_NEAR(map.travelled_m, travelled_m, 1e-9);
  }
  EXPECT_EQ(outcome.maps.back().last_node, node_poses.size() - 1);

  for (const FrontEndStep& step : outcome.steps) {
    EXPECT_LE(step.memberships.size(), 2U);
    for (std::size_t k = 0; k < step.memberships.size(); ++k) {
      const FrontEndStep::Membership& membership = step.memberships[k];
      const PlacedLocalMap& map = outcome.maps.at(membership.local_map);
      EXPECT_EQ(membership.anchor, map.anchor);
      EXPECT_GT(*step.node, map.first_node) << "the anchor is not a member";
      EXPECT_LE(*step.node, map.last_node);
      const TPose2D expected = between(map.local_T_map, step.local_T_robot);
      EXPECT_EQ(membership.anchor_T_node, expected);
      if (k > 0) {
        EXPECT_LT(step.memberships[k - 1].local_map, membership.local_map) << "older first";
      }
    }
    // A node is a member of each local map that holds it, except the local map that it anchors.
    if (step.node) {
      const auto holding =
          std::count_if(outcome.maps.begin(), outcome.maps.end(), [&](const PlacedLocalMap& map) {
            return map.first_node < *step.node && *step.node <= map.last_node;
          });
      EXPECT_EQ(static_cast<std::size_t>(holding), step.memberships.size()) << "node " << *step.node;
    }
  }
}

TEST(FrontEnd, local_maps_end_when_the_robot_has_travelled_far) {
  FrontEndOptions options;
  options.nodes_per_local_map = 100'000;
  options.local_map_travel_m = 8;
  const Outcome outcome = follow(drive_along(office_floor(), round_the_office(), {}, 13), options);
  ASSERT_GT(outcome.maps.size(), 6U);
  for (std::size_t i = 0; i + 2 < outcome.maps.size(); ++i) {
    EXPECT_GE(outcome.maps[i].travelled_m, 8);
    EXPECT_LT(outcome.maps[i].travelled_m, 8.5);
  }
}

// A local map across a stretch without matches would contain the error of odometry.
TEST(FrontEnd, no_local_map_spans_a_stretch_without_matches) {
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 17);
  const std::size_t first_blind = 100;
  const std::size_t last_blind = 140;
  for (std::size_t i = first_blind; i <= last_blind; ++i)
    std::fill(drive.frames[i].scan.ranges_m.begin(), drive.frames[i].scan.ranges_m.end(),
              std::numeric_limits<float>::quiet_NaN());
  FrontEndOptions options;
  options.nodes_per_local_map = 100'000;
  options.local_map_travel_m = 1000;
  const Outcome outcome = follow(drive, options);
  ASSERT_GT(outcome.maps.size(), 2U);
  double travelled_m = 0;  // path by odometry over the stretch without matches
  std::size_t node_before = 0;
  std::size_t node_after = 0;
  for (std::size_t i = 0; i < outcome.steps.size(); ++i) {
    if (i > first_blind && i <= last_blind)
      travelled_m += (drive.frames[i].odom_T_robot - drive.frames[i - 1].odom_T_robot).norm();
    if (outcome.steps[i].node && i < first_blind) node_before = *outcome.steps[i].node;
    if (outcome.steps[i].node && i > last_blind && node_after == 0) node_after = *outcome.steps[i].node;
  }
  ASSERT_GT(travelled_m, 1.0);
  ASSERT_GT(node_after, node_before);
  for (const PlacedLocalMap& map : outcome.maps)
    EXPECT_FALSE(map.first_node <= node_before && map.last_node >= node_after)
        << "local map " << map.id << " holds nodes from before and after";
  // Every node except the first is linked to the graph, because it is a member of an older local map.
  for (const FrontEndStep& step : outcome.steps)
    EXPECT_TRUE(!step.node || *step.node == 0 || !step.memberships.empty()) << "node " << *step.node;
}

TEST(FrontEnd, every_node_is_drawn_into_its_local_maps) {
  const SimulatedDrive drive = drive_along(office_floor(), round_the_office(), {}, 15);
  const Outcome outcome = follow(drive);
  for (const FrontEndStep& step : outcome.steps) {
    for (const FrontEndStep::Membership& membership : step.memberships) {
      const LocalMap::Agreement agreement =
          outcome.maps.at(membership.local_map).map->agreement(*step.points, membership.anchor_T_node);
      EXPECT_EQ(agreement.observed, step.points->points.size());
      EXPECT_GT(agreement.share(), 0.9);
    }
  }
}

template <class Value>
bool same_bytes(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(FrontEnd, the_same_frames_give_the_same_bytes_with_and_without_a_thread) {
  OdometryErrors errors;
  errors.length_share = 0.1;
  errors.turn_share = 0.2;
  const SimulatedDrive drive = drive_along(office_floor(), round_the_office(), errors, 16);
  const Outcome a = follow(drive);
  const Outcome b = follow(drive, {}, true);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    EXPECT_TRUE(same_bytes(a.steps[i].local_T_robot.x, b.steps[i].local_T_robot.x));
    EXPECT_TRUE(same_bytes(a.steps[i].local_T_robot.y, b.steps[i].local_T_robot.y));
    EXPECT_TRUE(same_bytes(a.steps[i].local_T_robot.phi, b.steps[i].local_T_robot.phi));
    EXPECT_TRUE(same_bytes(a.steps[i].response, b.steps[i].response));
    EXPECT_EQ(a.steps[i].information, b.steps[i].information);
  }
  ASSERT_EQ(a.maps.size(), b.maps.size());
  for (std::size_t m = 0; m < a.maps.size(); ++m) {
    const ScoreLevel& of_a = a.maps[m].map->scores().finest();
    const ScoreLevel& of_b = b.maps[m].map->scores().finest();
    ASSERT_EQ(of_a.memory_bytes(), of_b.memory_bytes());
    const auto first = [](const ScoreLevel& level) {
      return level.cell(-ScoreLevel::kMargin, -ScoreLevel::kMargin);
    };
    EXPECT_EQ(std::memcmp(first(of_a), first(of_b), of_a.memory_bytes()), 0);
  }
}

}  // namespace
}  // namespace psi_slam
