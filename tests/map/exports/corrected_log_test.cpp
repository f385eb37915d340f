// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/corrected_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "logs/frames/discarded_ranges.h"
#include "logs/frames/log_reader.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/open_log.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();

Frame frame(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot, std::vector<float> ranges_m) {
  Frame made;
  made.time_us = time_us;
  made.odom_T_robot = odom_T_robot;
  made.scan.ranges_m = std::move(ranges_m);
  made.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::vector<float>{-0.5F, 0, 0.5F});
  made.scan.max_range_m = 81.83F;
  made.scan.robot_T_laser = {0.25, 0, 0};
  return made;
}

std::vector<std::string> lines(const std::filesystem::path& path, const std::string& beginning) {
  std::ifstream file(path);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);)
    if (line.rfind(beginning, 0) == 0) found.push_back(line);
  return found;
}

TEST(CorrectedLog, writes_scans_in_order_with_both_poses_and_their_time) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trajectory.carmen";
  write_corrected_log(path,
                      {frame(2'000'001, {7, 8, 0.5}, {1.25F, kNoReturn, 0.01F}),
                       frame(1'500'000, {9, 8, 0.5}, {1, kInvalid, 3})},
                      {{1, 2, -0.25}, {3, 4, M_PI}});
  const auto scans = lines(path, "FLASER");
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0],
            "FLASER 3 1.25 81.83 0.01 1.000000000 2.000000000 -0.250000000"
            " 7.000000000 8.000000000 0.500000000 2.000001 psi-slam 2.000001");
  EXPECT_EQ(scans[1].rfind("FLASER 3 1 0 3 ", 0), 0U) << scans[1];
  EXPECT_EQ(lines(path, "PARAM robot_frontlaser_offset 0.25").size(), 1u);
  EXPECT_EQ(lines(path, "PARAM laser_front_laser_resolution 28.6479").size(), 1u);
  EXPECT_EQ(lines(path, "# beams: 3, from -28.6479 to 28.6479 degrees").size(), 1u);
}

TEST(CorrectedLog, reads_back_as_the_same_trajectory) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trajectory.carmen";
  write_corrected_log(path, {frame(976052905167303, {7, 8, 0.5}, {1, 2, 3})}, {{-1.123456789, 2, -0.25}});
  const Trajectory read = read_trajectory(path);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].time_us, 976052905167303);
  EXPECT_NEAR(read[0].pose.x, -1.123456789, 1e-12);
  EXPECT_NEAR(read[0].pose.phi, -0.25, 1e-12);
}

/// Ends of the beams in the robot's frame, from the right of the laser to its left.
std::vector<mrpt::math::TPoint2D> beam_ends(const LaserScan& scan) {
  std::vector<mrpt::math::TPoint2D> ends;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range_m = static_cast<double>(scan.ranges_m[i]);
    const auto bearing = static_cast<double>((*scan.bearings_rad)[i]);
    ends.push_back(scan.robot_T_laser.composePoint(
        mrpt::math::TPoint2D(range_m * std::cos(bearing), range_m * std::sin(bearing))));
  }
  if (scan.bearings_rad->front() > scan.bearings_rad->back()) std::reverse(ends.begin(), ends.end());
  return ends;
}

TEST(CorrectedLog, leaves_out_scans_whose_ranges_were_discarded) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trajectory.carmen";
  std::vector<Frame> log(3, frame(2'000'001, {7, 8, 0.5}, {1, 2, 3}));
  discard_ranges(log[1]);
  write_corrected_log(path, log, std::vector<mrpt::math::TPose2D>(3));
  EXPECT_EQ(lines(path, "FLASER").size(), 2U);
}

TEST(CorrectedLog, keeps_the_beams_of_lasers_with_any_mount) {
  constexpr int kBeams = 181;
  const mrpt::math::TPose2D rear(-0.31, 0.07, M_PI);
  const mrpt::math::TPose2D askew(0.2, -0.15, 0.75);
  for (const mrpt::math::TPose2D& mount : {rear, askew}) {
    for (const bool clockwise : {false, true}) {
      std::vector<float> ranges_m;
      std::vector<float> bearings;
      for (int i = 0; i < kBeams; ++i) {
        ranges_m.push_back(1 + 0.03F * static_cast<float>(i));
        const double bearing = M_PI * (static_cast<double>(i) / (kBeams - 1) - 0.5);
        bearings.push_back(static_cast<float>(clockwise ? -bearing : bearing));
      }
      Frame written = frame(1'000'000, {7, 8, 0.5}, ranges_m);
      written.scan.bearings_rad = std::make_shared<const std::vector<float>>(bearings);
      written.scan.robot_T_laser = mount;
      const TemporaryFolder folder;
      const auto path = folder.path() / "trajectory.carmen";
      write_corrected_log(path, {written}, {{1, 2, -0.25}});
      const auto read = open_carmen_log(path, LogOptions())->next();
      ASSERT_TRUE(read.has_value());
      const auto expected = beam_ends(written.scan);
      const auto ends = beam_ends(read->scan);
      ASSERT_EQ(ends.size(), expected.size());
      for (std::size_t i = 0; i < ends.size(); ++i) {
        ASSERT_NEAR(ends[i].x, expected[i].x, 1e-5) << i << (clockwise ? " clockwise" : "");
        ASSERT_NEAR(ends[i].y, expected[i].y, 1e-5) << i << (clockwise ? " clockwise" : "");
      }
      EXPECT_NEAR(read->odom_T_robot.x, 7, 1e-9);
    }
  }
}

TEST(CorrectedLog, needs_one_pose_per_scan) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_corrected_log(folder.path() / "x", {frame(1, {}, {1, 2, 3})}, {}),
               std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x"));
}

TEST(CorrectedLog, writes_a_line_per_laser_that_reads_back_as_one_frame) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trajectory.carmen";
  Frame both = frame(2'000'000, {7, 8, 0.5}, {1, 2, 3});
  CompanionScan rear{frame(0, {}, {4, 5, 6}).scan, 2'050'000, {0.1, 0, 0.05}};
  rear.scan.laser = 1;
  rear.scan.robot_T_laser = {-0.3, 0.1, M_PI / 2};
  both.companions = {rear};
  Frame rear_alone = frame(3'000'000, {9, 8, 0.5}, {7, 8, 9});
  rear_alone.scan = rear.scan;
  write_corrected_log(path, {both, rear_alone}, {{1, 2, 0}, {3, 4, 0}});
  ASSERT_EQ(lines(path, "FLASER").size(), 1u);
  ASSERT_EQ(lines(path, "RLASER").size(), 2u);
  EXPECT_EQ(lines(path, "RLASER")[0].substr(0, 51), "RLASER 3 4 5 6 1.100000000 2.000000000 0.050000000 ");

  LogOptions options;
  options.laser = "all";
  options.field_of_view_rad = 1.0;
  const auto log = open_log(path, options);
  const auto first = log->next();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->companions.size(), 1u);
  const CompanionScan& read = first->companions[0];
  EXPECT_EQ(read.time_us, rear.time_us);
  EXPECT_EQ(read.scan.ranges_m, rear.scan.ranges_m);
  EXPECT_NEAR(read.scan.robot_T_laser.phi, M_PI / 2, 1e-9);
  EXPECT_NEAR(read.frame_T_robot.x, 0.1, 1e-8);
  EXPECT_NEAR(read.frame_T_robot.phi, 0.05, 1e-8);
  const auto second = log->next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->scan.laser, 1u);
  EXPECT_FALSE(log->next());
}

}  // namespace
}  // namespace psi_slam
