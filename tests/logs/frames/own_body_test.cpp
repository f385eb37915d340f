// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/own_body.h"

#include <gtest/gtest.h>
#include <mrpt/core/bits_math.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "robot_body.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

Frame frame_of(const SimulatedRun& run, std::size_t i) {
  Frame frame;
  frame.index = i;
  frame.odom_T_robot = run.odometry[i];
  frame.scan = run.scan(i);
  return frame;
}

/// Mask of a run, whose frames `change` may change.
OwnBodyMask mask_of(const SimulatedRun& run, const std::function<void(Frame&)>& change) {
  OwnBodyFinder finder;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    Frame frame = frame_of(run, i);
    change(frame);
    finder.add(frame);
  }
  return finder.mask();
}

void put_body(Frame& frame) {
  RobotBody::put_into(frame.scan.ranges_m, frame.index);
}

const char* const kMastAndCable =
    "8 beams from -45.0 to -38.0 degrees at 0.35 m, 2 beams from 45.0 to 46.0 degrees at 0.60 m";

TEST(OwnBody, finds_a_mast_and_a_cable) {
  const SimulatedRun run = round_trips(2);
  EXPECT_EQ(text_of(mask_of(run, put_body).sectors()), kMastAndCable);
  EXPECT_EQ(text_of(mask_of(run, [](Frame&) {}).sectors()), "") << "nothing without the body";
}

TEST(OwnBody, masks_readings_of_the_body_and_keeps_those_that_pass_it) {
  const SimulatedRun run = round_trips(2);
  const OwnBodyMask mask = mask_of(run, put_body);
  std::size_t masked = 0;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    const LaserScan clean = run.scan(i);
    LaserScan scan = clean;
    RobotBody::put_into(scan.ranges_m, i);
    const LaserScan seen = scan;
    mask.apply(scan);
    for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
      const bool is_body = seen.ranges_m[beam] != clean.ranges_m[beam];
      EXPECT_EQ(std::isnan(scan.ranges_m[beam]), is_body) << "scan " << i << ", beam " << beam;
      if (is_body) ++masked;
    }
  }
  EXPECT_GT(masked, 8 * run.truth.size());
}

TEST(OwnBody, needs_a_robot_that_turns_and_travels) {
  EXPECT_EQ(text_of(mask_of(simulated_run({{0.05, 0, 150}}), put_body).sectors()), "") << "straight ahead";
  EXPECT_EQ(text_of(mask_of(simulated_run({{0.0, 3, 400}}), put_body).sectors()), "") << "on the spot";
  EXPECT_EQ(text_of(mask_of(simulated_run({{0.0, -4.0, 60}, {0.05, 0, 50}}), put_body).sectors()), "")
      << "less than one turn";
}

TEST(OwnBody, ignores_odometry_that_turns_while_the_robot_stands) {
  SimulatedRun run = simulated_run({{0.05, 0, 60}, {0, 0, 800}});
  for (std::size_t i = 0; i < run.odometry.size(); ++i) run.odometry[i].phi = 0.02 * static_cast<double>(i);
  EXPECT_EQ(text_of(mask_of(run, put_body).sectors()), "");
}

TEST(OwnBody, keeps_a_wall_that_the_robot_follows_around_corners) {
  std::vector<Wall> walls;
  add_box(walls, 0, 0, 5, 4);
  add_box(walls, 2, 1.8, 3, 2.2);
  OwnBodyFinder finder;
  const std::vector<float> bearings = make_bearings_rad(BeamAngles::kLeftOpen, 180, M_PI);
  TPose2D robot{0.5, 0.5, 0};  // half a metre from the walls on its right
  std::size_t scans = 0;
  std::size_t near_scans = 0;
  const auto scan = [&] {
    Frame frame;
    frame.index = scans++;
    frame.odom_T_robot = robot;
    for (const float bearing : bearings)
      frame.scan.ranges_m.push_back(
          static_cast<float>(range_m(walls, robot + TPose2D{0, 0, static_cast<double>(bearing)})));
    frame.scan.bearings_rad = std::make_shared<const std::vector<float>>(bearings);
    if (std::abs(frame.scan.ranges_m[0] - 0.5F) < 0.03F) ++near_scans;
    finder.add(frame);
  };
  for (int side = 0; side < 40; ++side) {
    for (int i = 0; i < (side % 2 == 0 ? 40 : 30); ++i, robot = robot + TPose2D{0.1, 0, 0}) scan();
    for (int i = 0; i < 30; ++i, robot = robot + TPose2D{0, 0, DEG2RAD(3.0)}) scan();
  }
  EXPECT_TRUE(finder.settled());
  EXPECT_GT(near_scans, scans / 2) << "the beam to the right measures the same range in most scans";
  EXPECT_EQ(text_of(finder.mask().sectors()), "");
}

TEST(OwnBody, keeps_a_person_who_walks_alongside) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 0.03);
  double off_m = 0;
  const auto walk = [&](Frame& frame) {
    off_m = 0.95 * off_m + step(random);
    for (std::size_t beam = 120; beam < 150; ++beam)
      frame.scan.ranges_m[beam] = static_cast<float>(0.7 + off_m);
  };
  EXPECT_EQ(text_of(mask_of(round_trips(4), walk).sectors()), "");
}

TEST(OwnBody, is_found_by_bearing_where_the_number_of_beams_changes) {
  SimulatedRun run = round_trips(2);
  const std::vector<float> few = make_bearings_rad(BeamAngles::kCentredStepInclusive, 454, M_PI);
  const std::vector<float> many = make_bearings_rad(BeamAngles::kCentredStepInclusive, 456, M_PI);
  OwnBodyFinder finder;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    run.bearings_rad = i % 3 == 1 ? many : few;
    Frame frame = frame_of(run, i);
    for (std::size_t beam = 0; beam < run.bearings_rad.size(); ++beam)
      if (std::abs(run.bearings_rad[beam] - 0.5F) < 0.035F) frame.scan.ranges_m[beam] = 0.35F;
    finder.add(frame);
  }
  const std::vector<BodySector> sectors = finder.mask().sectors();
  ASSERT_EQ(sectors.size(), 1U);
  EXPECT_NEAR(sectors[0].from_rad, 0.465, 0.011);
  EXPECT_NEAR(sectors[0].to_rad, 0.535, 0.011);
}

TEST(OwnBody, behind_the_laser_is_masked_on_both_sides_of_the_seam) {
  SimulatedRun run = round_trips(2);
  const auto behind = [](float bearing_rad) { return std::abs(bearing_rad) > 3.12F; };
  OwnBodyFinder finder;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> scatter(-0.004F, 0.004F);  // as of the points of a sliced cloud
  const std::vector<float> even = make_bearings_rad(BeamAngles::kCentredHalfStep, 720, 2 * M_PI);
  const auto next_frame = [&](std::size_t i) {
    run.bearings_rad = even;
    for (float& bearing : run.bearings_rad) bearing += scatter(random);
    Frame frame = frame_of(run, i);
    for (std::size_t beam = 0; beam < even.size(); ++beam)
      if (behind(run.bearings_rad[beam])) frame.scan.ranges_m[beam] = 0.3F;
    return frame;
  };
  for (std::size_t i = 0; i < run.truth.size(); ++i) finder.add(next_frame(i));
  const OwnBodyMask mask = finder.mask();
  for (std::size_t i = 0; i < 20; ++i) {
    const Frame frame = next_frame(i);
    LaserScan scan = frame.scan;
    mask.apply(scan);
    for (std::size_t beam = 0; beam < even.size(); ++beam) {
      if (behind(run.bearings_rad[beam])) {
        EXPECT_TRUE(std::isnan(scan.ranges_m[beam])) << "scan " << i << ", beam " << beam;
      } else {
        EXPECT_EQ(scan.ranges_m[beam], frame.scan.ranges_m[beam]) << "scan " << i << ", beam " << beam;
      }
    }
  }
}

TEST(OwnBody, is_found_without_odometry) {
  const SimulatedRun run = round_trips(3);
  const auto without_odometry = [](Frame& frame) {
    frame.has_odometry = false;
    frame.odom_T_robot = {};
  };
  EXPECT_EQ(text_of(mask_of(run, without_odometry).sectors()), "");
  const OwnBodyMask mask = mask_of(run, [&](Frame& frame) {
    without_odometry(frame);
    put_body(frame);
  });
  ASSERT_FALSE(mask.sectors().empty());
  EXPECT_EQ(text_of({mask.sectors().front()}), "8 beams from -45.0 to -38.0 degrees at 0.35 m");
}

TEST(OwnBody, is_found_by_the_heading_of_a_gyroscope) {
  const SimulatedRun run = round_trips(2);
  double heading_rad = 0;
  const OwnBodyMask mask = mask_of(run, [&](Frame& frame) {
    if (frame.index > 0)
      heading_rad += mrpt::math::wrapToPi(run.truth[frame.index].phi - run.truth[frame.index - 1].phi);
    frame.imu_heading_rad = heading_rad;
    frame.has_odometry = false;
    put_body(frame);
  });
  EXPECT_EQ(text_of(mask.sectors()), kMastAndCable);
}

TEST(OwnBody, is_found_for_each_laser) {
  const SimulatedRun run = round_trips(2);
  OwnBodyFinder finder;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    Frame frame = frame_of(run, i);
    finder.add(frame);
    frame.scan.laser = 1;
    put_body(frame);
    finder.add(frame);
  }
  const OwnBodyMask mask = finder.mask();
  ASSERT_EQ(mask.sectors().size(), 2U);
  EXPECT_EQ(mask.sectors()[0].laser, 1U);
  LaserScan scan = run.scan(0);
  RobotBody::put_into(scan.ranges_m, 0);
  const std::vector<float> ranges_m = scan.ranges_m;
  mask.apply(scan);
  EXPECT_EQ(scan.ranges_m, ranges_m) << "laser 0 sees no body";
  scan.laser = 1;
  mask.apply(scan);
  EXPECT_TRUE(std::isnan(scan.ranges_m[RobotBody::first_mast_beam(180)]));
}

TEST(OwnBody, text_counts_the_sectors_it_does_not_name) {
  BodySector sector;
  sector.beams = 1;
  sector.nearest_m = 0.2;
  sector.farthest_m = 0.4;
  const std::string one = "1 beam at 0.0 degrees at 0.20 to 0.40 m";
  EXPECT_EQ(text_of(std::vector<BodySector>(2, sector)), one + ", " + one);
  std::string five = one;
  for (int i = 1; i < 5; ++i) five += ", " + one;
  EXPECT_EQ(text_of(std::vector<BodySector>(6, sector)), five + ", and 1 other sector");
}

}  // namespace
}  // namespace psi_slam
