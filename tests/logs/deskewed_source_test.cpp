// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/deskewed_source.h"

#include <gmock/gmock.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <limits>

#include "bag_files.h"
#include "log_files.h"
#include "logs/frames/pose_operations.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Scan of the furnished room. Its beams are measured one after the other while the robot moves from `start`
/// by `motion`. `backward`: the last beam is measured first.
LaserScan sweep(const TPose2D& start, const TPose2D& motion, const TPose2D& mount, bool clockwise = false,
                bool backward = false) {
  const std::vector<Wall> walls = furnished_room();
  std::vector<float> bearings = make_bearings_rad(BeamAngles::kLeftOpen, 720, 2 * M_PI);
  if (clockwise)
    for (float& bearing : bearings) bearing = -bearing;
  LaserScan scan;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const double share = static_cast<double>(backward ? bearings.size() - 1 - i : i) /
                         static_cast<double>(bearings.size() - 1);
    const TPose2D world_T_robot = start + interpolate({0, 0, 0}, motion, share);
    scan.ranges_m.push_back(static_cast<float>(
        range_m(walls, world_T_robot + mount + TPose2D{0, 0, static_cast<double>(bearings[i])})));
  }
  scan.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings));
  scan.robot_T_laser = mount;
  scan.max_range_m = 50;
  scan.sweep_time_s = backward ? -0.1F : 0.1F;
  return scan;
}

/// Largest distance in metres of a beam's end from the nearest wall. Takes `world_T_robot` as the robot's
/// pose at every beam.
double farthest_from_walls_m(const LaserScan& scan, const TPose2D& world_T_robot) {
  const std::vector<Wall> walls = furnished_room();
  double farthest = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const TPose2D end = world_T_robot + scan.robot_T_laser +
                        TPose2D{0, 0, static_cast<double>((*scan.bearings_rad)[i])} +
                        TPose2D{static_cast<double>(scan.ranges_m[i]), 0, 0};
    double nearest = 1e3;
    for (const Wall& wall : walls) {
      const double ex = wall.x2 - wall.x1;
      const double ey = wall.y2 - wall.y1;
      const double along = ((end.x - wall.x1) * ex + (end.y - wall.y1) * ey) / (ex * ex + ey * ey);
      const double share = std::min(1.0, std::max(0.0, along));
      nearest = std::min(nearest, std::hypot(wall.x1 + share * ex - end.x, wall.y1 + share * ey - end.y));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(Deskewed, a_sweep_of_a_moving_robot_ends_on_the_walls) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 40; ++i) {
    const TPose2D start{2 + unit(random), 1.8 + 0.5 * unit(random), 3 * unit(random)};
    const TPose2D motion{0.15 * unit(random), 0.05 * unit(random), 0.3 * unit(random)};
    const TPose2D mount{0.3 * unit(random), 0.2 * unit(random), 3 * unit(random)};
    const LaserScan moving = sweep(start, motion, mount, i % 2 == 1, i % 4 > 1);
    const LaserScan still = deskewed(moving, motion);
    EXPECT_LT(farthest_from_walls_m(still, start), 1e-5) << i;
    EXPECT_EQ(still.sweep_time_s, 0);
    EXPECT_GT(farthest_from_walls_m(moving, start), 1e-3)
        << "without an effect of the motion the test would show nothing";
    for (std::size_t k = 0; k < still.ranges_m.size(); ++k)
      EXPECT_LT(std::abs((*still.bearings_rad)[k] - (*moving.bearings_rad)[k]), M_PI)
          << "no bearing jumps by a full turn";
  }
}

TEST(Deskewed, a_sweep_while_turning_on_the_spot_equals_a_scan_at_rest) {
  const TPose2D start{2, 1.8, 0.4};
  const LaserScan still = deskewed(sweep(start, {0, 0, 0.2}, {0, 0, 0}), {0, 0, 0.2});
  const std::vector<Wall> walls = furnished_room();
  for (std::size_t i = 0; i < still.ranges_m.size(); ++i) {
    const TPose2D ray = start + TPose2D{0, 0, static_cast<double>((*still.bearings_rad)[i])};
    EXPECT_NEAR(static_cast<double>(still.ranges_m[i]), range_m(walls, ray), 2e-4) << i;
  }
}

TEST(Deskewed, a_beam_without_return_turns_with_the_robot) {
  LaserScan scan;
  scan.ranges_m = {1, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  scan.bearings_rad = std::make_shared<const std::vector<float>>(std::vector<float>{-1, 0, 1});
  const LaserScan still = deskewed(scan, {0.1, 0, 0.2});
  EXPECT_EQ(still.ranges_m[0], 1.0F);
  EXPECT_TRUE(std::isnan(still.ranges_m[1]) && std::isinf(still.ranges_m[2]));
  EXPECT_THAT(*still.bearings_rad, testing::Pointwise(testing::FloatNear(1e-6F), {-1.0F, 0.1F, 1.2F}));
}

// ---- Whole logs ----

/// Recording of a robot that turns at 1 rad/s in a room that looks the same on all sides. De-skewing changes
/// only the bearings of its scans.
Recording turning_robot(float time_increment_s) {
  Recording recording{static_mount("laser", {0, 0, 0, 0, 0, 0})};
  constexpr TimeUs kStart = 1'600'000'000'000'000;
  for (TimeUs t = 0; t <= 500'000; t += 50'000) {
    recording.emplace_back(
        RecordedPose{"/odom", kStart + t, "odom", "base_link", {0, 0, 0, seconds(t), 0, 0}});
    if (t % 100'000 != 0) continue;
    RecordedScan scan;
    scan.time_us = kStart + t;
    scan.ranges_m = {4, 4, 4, 4, 4};
    scan.time_increment_s = time_increment_s;
    recording.emplace_back(scan);
  }
  return recording;
}

std::vector<Frame> frames_from(const Recording& recording, const LogOptions& options = {}) {
  const TemporaryFolder folder;
  write_mcap(folder.path() / "run.mcap", recording);
  return frames_of(folder.path() / "run.mcap", options);
}

TEST(DeskewedLog, removes_the_motion_during_the_sweep_that_the_bag_states) {
  const auto frames = frames_from(turning_robot(0.02F));
  ASSERT_EQ(frames.size(), 6U);
  for (const Frame& frame : frames)  // the last frame uses the motion before it
    EXPECT_THAT(*frame.scan.bearings_rad,
                testing::Pointwise(testing::FloatNear(1e-5F), {-1.0F, -0.48F, 0.04F, 0.56F, 1.08F}));
}

TEST(DeskewedLog, is_unchanged_without_a_sweep_time_or_if_the_user_states_0) {
  LogOptions off;
  off.sweep_time_s = 0;
  for (const auto& frames : {frames_from(turning_robot(0)), frames_from(turning_robot(0.02F), off),
                             frames_from(turning_robot(0.9F)), frames_from(turning_robot(-0.9F))})
    for (const Frame& frame : frames)
      EXPECT_THAT(*frame.scan.bearings_rad, testing::ElementsAre(-1.0F, -0.5F, 0.0F, 0.5F, 1.0F));
}

TEST(DeskewedLog, moves_the_beams_to_the_last_one_if_it_is_measured_first) {
  LogOptions backward;
  backward.sweep_direction = SweepDirection::kBackward;
  LogOptions forward;
  forward.sweep_direction = SweepDirection::kForward;
  for (const auto& frames : {frames_from(turning_robot(-0.02F)), frames_from(turning_robot(0.02F), backward),
                             frames_from(turning_robot(-0.02F), backward)})
    for (const Frame& frame : frames)
      EXPECT_THAT(*frame.scan.bearings_rad,
                  testing::Pointwise(testing::FloatNear(1e-5F), {-0.92F, -0.44F, 0.04F, 0.52F, 1.0F}));
  for (const Frame& frame : frames_from(turning_robot(-0.02F), forward))
    EXPECT_THAT(*frame.scan.bearings_rad,
                testing::Pointwise(testing::FloatNear(1e-5F), {-1.0F, -0.48F, 0.04F, 0.56F, 1.08F}));
}

TEST(DeskewedLog, uses_the_stated_sweep_time_in_any_format) {
  const TemporaryFolder folder;
  write_carmen(folder.path() / "log", turning_robot(0));
  LogOptions options;
  options.sweep_time_s = 0.04;
  const auto frames = frames_of(folder.path() / "log", options);
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_THAT(*frames[0].scan.bearings_rad,
              testing::Pointwise(testing::FloatNear(1e-5F), {-1.0F, -0.49F, 0.02F, 0.53F, 1.04F}));
  options.sweep_direction = SweepDirection::kBackward;
  EXPECT_THAT(*frames_of(folder.path() / "log", options)[0].scan.bearings_rad,
              testing::Pointwise(testing::FloatNear(1e-5F), {-0.96F, -0.47F, 0.02F, 0.51F, 1.0F}));
}

}  // namespace
}  // namespace psi_slam
