// SPDX-License-Identifier: BSD-3-Clause
#include "logs/observations/mrpt_objects.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/system/datetime.h>

#include <cmath>
#include <limits>

#include "simulated_room.h"

namespace psi_slam {
namespace {

constexpr double kDegree = M_PI / 180;

Frame frame_with(const BeamBearings& bearings) {
  Frame frame;
  frame.time_us = 976052905167303;
  frame.scan.bearings_rad = bearings;
  frame.scan.max_range_m = 30;
  frame.scan.robot_T_laser = {0.25, 0.125, 0.5};
  for (std::size_t i = 0; i < bearings->size(); ++i)
    frame.scan.ranges_m.push_back(1 + 0.01F * static_cast<float>(i));
  return frame;
}

/// Returns the direction of ray `i` in the robot's frame, in radians, as MRPT defines it.
double direction(const mrpt::obs::CObservation2DRangeScan& observation, std::size_t i) {
  const double step =
      static_cast<double>(observation.aperture) / static_cast<double>(observation.getScanSize() - 1);
  const double sign = observation.rightToLeft ? 1 : -1;
  return observation.sensorPose.yaw() +
         sign * (static_cast<double>(i) * step - static_cast<double>(observation.aperture) / 2);
}

void expect_correct_bearings(const Frame& frame, double tolerance_rad) {
  const auto observation = range_observation(frame);
  std::size_t beam = 0;
  for (std::size_t ray = 0; ray < observation->getScanSize(); ++ray) {
    if (!observation->getScanRangeValidity(ray)) continue;
    ASSERT_LT(beam, frame.scan.ranges_m.size());
    EXPECT_EQ(observation->getScanRange(ray), frame.scan.ranges_m[beam]);
    EXPECT_NEAR(direction(*observation, ray),
                frame.scan.robot_T_laser.phi + static_cast<double>((*frame.scan.bearings_rad)[beam]),
                tolerance_rad);
    ++beam;
  }
  EXPECT_EQ(beam, frame.scan.ranges_m.size());
}

TEST(TimeOfObservation, round_trips_up_to_the_largest_time_stamp) {
  mrpt::obs::CObservationOdometry observation;
  for (const TimeUs time :
       {TimeUs{0}, TimeUs{976052905167303}, kMostTimeUs, TimeUs{-11'000'000'000'000'000}}) {
    observation.timestamp = mrpt_clock_time(time);
    EXPECT_EQ(time_us(observation), time);
  }
  observation.timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(INT64_MAX));
  EXPECT_EQ(time_us(observation), std::nullopt);
}

TEST(RangeObservation, even_beams_are_unchanged) {
  const Frame frame = frame_with(even_bearings(-90 * kDegree, 90 * kDegree, 181));
  const auto observation = range_observation(frame);
  EXPECT_EQ(observation->getScanSize(), 181U);
  EXPECT_NEAR(static_cast<double>(observation->aperture), M_PI, 1e-6);
  EXPECT_NEAR(observation->sensorPose.x(), 0.25, 1e-12);
  expect_correct_bearings(frame, 1e-6);
}

TEST(RangeObservation, the_sensor_pose_includes_the_mean_bearing) {
  expect_correct_bearings(frame_with(even_bearings(-90 * kDegree, 89 * kDegree, 180)), 1e-6);
}

TEST(RangeObservation, beams_from_left_to_right_keep_their_order) {
  const Frame frame = frame_with(even_bearings(90 * kDegree, -45 * kDegree, 136));
  EXPECT_FALSE(range_observation(frame)->rightToLeft);
  expect_correct_bearings(frame, 1e-6);
}

TEST(RangeObservation, the_missing_beam_of_gmapping_becomes_an_invalid_ray) {
  std::vector<float> bearings;
  for (int degree = -90; degree <= 90; ++degree)
    if (degree != 0) bearings.push_back(static_cast<float>(degree * kDegree));
  const Frame frame = frame_with(std::make_shared<const std::vector<float>>(bearings));
  EXPECT_EQ(range_observation(frame)->getScanSize(), 181U);
  expect_correct_bearings(frame, 1e-6);
}

TEST(RangeObservation, uneven_beams_are_approximated) {
  const auto bearings =
      std::make_shared<const std::vector<float>>(std::vector<float>{-1, -0.7F, -0.1F, 0.2F, 0.35F, 1});
  expect_correct_bearings(frame_with(bearings), 0.1);
}

TEST(RangeObservation, beams_without_return_are_invalid_and_the_time_is_exact) {
  Frame frame = frame_with(even_bearings(-1, 1, 3));
  frame.scan.ranges_m[1] = std::numeric_limits<float>::quiet_NaN();
  frame.scan.ranges_m[2] = std::numeric_limits<float>::infinity();
  const auto observation = range_observation(frame);
  EXPECT_TRUE(observation->getScanRangeValidity(0));
  for (const std::size_t beam : {1, 2}) EXPECT_FALSE(observation->getScanRangeValidity(beam));
  EXPECT_EQ(observation->getScanRange(1), 0) << "an invalid reading";
  EXPECT_EQ(observation->getScanRange(2), frame.scan.max_range_m) << "no return";
  EXPECT_EQ(observation->timestamp - mrpt::Clock::fromDouble(976052905), std::chrono::microseconds(167303));
}

TEST(RangeObservations, include_all_lasers_relative_to_the_frames_pose) {
  Frame frame;
  frame.time_us = 5'000'000;
  frame.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::vector<float>{-1, 0, 1});
  frame.scan.ranges_m = {1, 2, 3};
  frame.scan.max_range_m = 30;
  CompanionScan rear{frame.scan, 5'040'000, {0.5, 0, M_PI / 2}};
  rear.scan.laser = 1;
  rear.scan.robot_T_laser = {-0.3, 0, M_PI};
  frame.companions = {rear};
  const auto observations = range_observations(frame);
  ASSERT_EQ(observations.size(), 2U);
  EXPECT_EQ(observations[0]->sensorLabel, "LASER");
  EXPECT_EQ(observations[1]->sensorLabel, "LASER2");
  EXPECT_EQ(time_us(*observations[1]), TimeUs{5'040'000});
  EXPECT_NEAR(observations[1]->sensorPose.x(), 0.5, 1e-9);
  EXPECT_NEAR(observations[1]->sensorPose.y(), -0.3, 1e-9);
  EXPECT_NEAR(observations[1]->sensorPose.yaw(), -M_PI / 2, 1e-9);
}

std::optional<TimeUs> read_back(mrpt::Clock::time_point stamp) {
  mrpt::obs::CObservationOdometry observation;
  observation.timestamp = stamp;
  return time_us(observation);
}

TEST(MrptTime, counts_as_mrpt_does) {
  for (const TimeUs time : {TimeUs{0}, TimeUs{976052905167303}}) {
    EXPECT_NEAR(mrpt::Clock::toDouble(mrpt_clock_time(time)), seconds(time), 1e-6);
    EXPECT_EQ(read_back(mrpt_clock_time(time)), time);
  }
  EXPECT_EQ(read_back(mrpt_clock_time(-1'500'000)), -1'500'000);
}

TEST(MrptTime, is_rounded_to_the_nearest_microsecond) {
  const mrpt::Clock::time_point whole = mrpt_clock_time(1'000);
  EXPECT_EQ(read_back(whole + mrpt::Clock::duration(4)), 1'000);
  EXPECT_EQ(read_back(whole + mrpt::Clock::duration(5)), 1'001);
  EXPECT_EQ(read_back(whole - mrpt::Clock::duration(4)), 1'000);
}

TEST(MrptTime, is_empty_without_a_time_stamp) {
  EXPECT_EQ(read_back(INVALID_TIMESTAMP), std::nullopt);
}

}  // namespace
}  // namespace psi_slam
