// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/gyroscope_check.h"

#include <gmock/gmock.h>

#include <cmath>

namespace psi_slam {
namespace {

/// A robot that turns to and fro. The gyroscope measures `gain` times its turns, with a bias.
MappingResult turning_robot(double gain, std::size_t scans = 200) {
  MappingResult result;
  for (std::size_t i = 0; i < scans; ++i) {
    const double time_s = 0.1 * static_cast<double>(i);
    FrameRecord record;
    record.time_us = static_cast<TimeUs>(time_s * 1e6);
    record.match = ScanMatch::kMatched;
    record.map_T_robot.phi = 0.8 * std::sin(time_s);
    Frame frame;
    frame.time_us = record.time_us;
    frame.has_odometry = false;
    frame.imu_heading_rad = gain * record.map_T_robot.phi + 0.02 * time_s;
    result.frames.push_back(record);
    result.log.push_back(frame);
  }
  return result;
}

std::optional<std::string> rejected(const MappingResult& result) {
  return rejected_gyroscope(result, {0, result.log.size()});
}

TEST(GyroscopeCheck, names_a_gyroscope_with_a_wrong_sign_or_unit) {
  EXPECT_EQ(rejected(turning_robot(1)), std::nullopt);
  for (const double gain : {-1.0, 180 / M_PI})
    EXPECT_THAT(rejected(turning_robot(gain)).value_or(""),
                testing::AllOf(testing::StartsWith("the gyroscope contradicts the scans in "),
                               testing::HasSubstr("log.imu=none")));
}

TEST(GyroscopeCheck, needs_matched_scans_without_odometry) {
  EXPECT_EQ(rejected(turning_robot(-1, 20)), std::nullopt) << "too few scans";
  MappingResult unmatched = turning_robot(-1);
  for (FrameRecord& record : unmatched.frames) record.match = ScanMatch::kUnmatched;
  EXPECT_EQ(rejected(unmatched), std::nullopt);
  MappingResult with_odometry = turning_robot(-1);
  for (Frame& frame : with_odometry.log) frame.has_odometry = true;
  EXPECT_EQ(rejected(with_odometry), std::nullopt);
  EXPECT_EQ(rejected({}), std::nullopt) << "no scan";
}

}  // namespace
}  // namespace psi_slam
