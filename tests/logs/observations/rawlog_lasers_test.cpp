// SPDX-License-Identifier: BSD-3-Clause
#include "logs/observations/observation_frames.h"

#include <gmock/gmock.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/poses/CPoint3D.h>

#include <cmath>

#include "log_files.h"
#include "rawlog_files.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::poses::CPose3D;
using testing::ElementsAre;

LaserScan scan_of(const mrpt::obs::CObservation2DRangeScan& observation, const LogOptions& options = {}) {
  return RawlogLaser(options).scan(observation, "log: object 1");
}

TEST(RawlogLaser, bearings_follow_aperture_and_direction) {
  const auto observation = range_scan(1);
  EXPECT_THAT(*scan_of(*observation).bearings_rad, ElementsAre(-1.0F, -0.5F, 0.0F, 0.5F, 1.0F));
  observation->rightToLeft = false;
  EXPECT_THAT(*scan_of(*observation).bearings_rad, ElementsAre(1.0F, 0.5F, 0.0F, -0.5F, -1.0F));
}

TEST(RawlogLaser, agrees_with_mrpts_points) {
  for (const bool right_to_left : {true, false}) {
    for (const double roll_deg : {0.0, 180.0}) {
      const auto observation = range_scan(1);
      observation->rightToLeft = right_to_left;
      observation->sensorPose = CPose3D(0.5, -0.25, 0.75, DEG2RAD(30.0), 0, DEG2RAD(roll_deg));
      const LaserScan scan = scan_of(*observation);
      for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
        const auto bearing = static_cast<double>(observation->getScanAngle(i));
        const auto range = static_cast<double>(observation->getScanRange(i));
        const auto expected = observation->sensorPose +
                              mrpt::poses::CPoint3D(range * std::cos(bearing), range * std::sin(bearing), 0);
        const auto ours = static_cast<double>((*scan.bearings_rad)[i]);
        const TPose2D found = scan.robot_T_laser + TPose2D{range * std::cos(ours), range * std::sin(ours), 0};
        EXPECT_NEAR(found.x, expected.x(), 1e-6) << right_to_left << " " << roll_deg << " " << i;
        EXPECT_NEAR(found.y, expected.y(), 1e-6) << right_to_left << " " << roll_deg << " " << i;
      }
    }
  }
}

TEST(RawlogLaser, rejects_a_tilted_laser) {
  const auto observation = range_scan(1);
  observation->sensorPose = CPose3D(0, 0, 0, 0, DEG2RAD(10.0), 0);
  EXPECT_NO_THROW(scan_of(*observation));
  observation->sensorPose = CPose3D(0, 0, 0, 0, DEG2RAD(40.0), 0);
  EXPECT_EQ(
      sentence_of([&] { scan_of(*observation); }),
      "log: object 1: the laser is tilted by 40 degrees, expected at most 15. Select another laser with "
      "log.laser");
}

TEST(RawlogLaser, marks_readings_without_a_return) {
  const auto observation = range_scan(1, "LASER", {1, -1, 0, std::nanf(""), 2, 30, 30});
  observation->setScanRangeValidity(4, false);
  observation->setScanRangeValidity(5, false);
  const auto ranges_m = scan_of(*observation).ranges_m;
  EXPECT_EQ(ranges_m[0], 1);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(std::isnan(ranges_m[i])) << i;
  EXPECT_TRUE(std::isinf(ranges_m[5])) << "MRPT marks rays without return as invalid";
  EXPECT_TRUE(std::isinf(ranges_m[6])) << "a valid reading at the maximum range counts as no return";
}

TEST(RawlogLaser, options_override_the_log) {
  LogOptions options;
  options.robot_T_laser = TPose2D{1, 2, 0.5};
  options.max_range_m = 4.5;
  options.min_range_m = 1.5;
  options.mirrored = true;
  options.beam_angles = BeamAngles::kLeftOpen;
  options.field_of_view_rad = 2.5;
  const LaserScan scan = scan_of(*range_scan(1), options);
  EXPECT_EQ(scan.robot_T_laser, (TPose2D{1, 2, 0.5}));
  EXPECT_EQ(scan.max_range_m, 4.5F);
  EXPECT_TRUE(std::isnan(scan.ranges_m[0]));
  EXPECT_TRUE(std::isinf(scan.ranges_m[4]));
  EXPECT_THAT(*scan.bearings_rad, ElementsAre(1.25F, 0.75F, 0.25F, -0.25F, -0.75F));
}

TEST(RawlogLaser, shares_bearings_until_the_sensor_changes) {
  RawlogLaser laser{LogOptions{}};
  const auto observation = range_scan(1);
  const auto first = laser.scan(*observation, "");
  EXPECT_EQ(laser.scan(*observation, "").bearings_rad.get(), first.bearings_rad.get());
  observation->aperture = 1.0F;
  EXPECT_EQ(laser.scan(*observation, "").bearings_rad->back(), 0.5F);
  observation->rightToLeft = false;
  EXPECT_EQ(laser.scan(*observation, "").bearings_rad->back(), -0.5F);
}

TEST(RawlogLaser, rejects_a_scan_without_rays) {
  EXPECT_EQ(sentence_of([] { scan_of(*range_scan(1, "LASER", {})); }),
            "log: object 1: the scan has 0 rays, expected 1 or more. Remove the scan from the log");
}

}  // namespace
}  // namespace psi_slam
