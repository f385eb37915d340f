// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/gyroscope_headings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

constexpr TimeUs kMs = 1'000;

Frame scan_at(TimeUs time_us, std::size_t laser = 0) {
  Frame frame;
  frame.time_us = time_us;
  frame.scan.laser = laser;
  return frame;
}

/// Adds rates every 10 ms.
void add_rates(GyroscopeHeadings& headings, TimeUs from_us, TimeUs to_us, double rate_radps) {
  for (TimeUs time_us = from_us; time_us <= to_us; time_us += 10 * kMs)
    headings.add_rate(time_us, rate_radps);
}

std::optional<double> heading_at(GyroscopeHeadings& headings, TimeUs time_us, std::size_t laser = 0) {
  headings.add_scan(scan_at(time_us, laser));
  const auto frame = headings.take();
  EXPECT_TRUE(frame) << time_us;
  return frame ? frame->imu_heading_rad : std::nullopt;
}

TEST(GyroscopeHeadings, integrates_the_rate_to_the_time_of_each_scan) {
  GyroscopeHeadings headings;
  for (TimeUs time_us = 0; time_us <= 4000 * kMs; time_us += 10 * kMs)
    headings.add_rate(time_us, std::sin(seconds(time_us)));
  for (const TimeUs time_us : {0 * kMs, 5 * kMs, 1234 * kMs, 4000 * kMs})
    EXPECT_NEAR(heading_at(headings, time_us).value(), 1 - std::cos(seconds(time_us)), 1e-4);
}

TEST(GyroscopeHeadings, scans_wait_for_a_rate_of_their_time_and_keep_their_order) {
  GyroscopeHeadings headings;
  add_rates(headings, 0, 100 * kMs, 1);
  headings.add_scan(scan_at(115 * kMs));
  headings.add_scan(scan_at(50 * kMs));
  EXPECT_FALSE(headings.take());
  headings.add_rate(110 * kMs, 1);
  EXPECT_FALSE(headings.take());
  headings.add_rate(120 * kMs, 1);
  EXPECT_NEAR(headings.take()->imu_heading_rad.value(), 0.115, 1e-9);
  EXPECT_NEAR(headings.take()->imu_heading_rad.value(), 0.05, 1e-9);
  EXPECT_FALSE(headings.take());
}

TEST(GyroscopeHeadings, scans_without_rates_of_their_time_have_no_heading) {
  GyroscopeHeadings headings;
  headings.add_scan(scan_at(-5 * kMs));
  EXPECT_FALSE(headings.take()) << "rates may still arrive";
  add_rates(headings, 0, 100 * kMs, 1);
  EXPECT_FALSE(headings.take()->imu_heading_rad) << "the scan is before the first rate";
  headings.add_scan(scan_at(150 * kMs));
  headings.add_scan(scan_at(1100 * kMs));
  EXPECT_FALSE(headings.take()) << "rates may still arrive";
  headings.add_scan(scan_at(1160 * kMs));
  EXPECT_FALSE(headings.take()->imu_heading_rad) << "the rates have stopped";
  EXPECT_FALSE(headings.take());
  headings.end_of_log();
  EXPECT_FALSE(headings.take()->imu_heading_rad);
  EXPECT_FALSE(headings.take()->imu_heading_rad);
  EXPECT_FALSE(headings.take());
}

TEST(GyroscopeHeadings, the_turn_across_a_gap_is_unknown) {
  GyroscopeHeadings headings;
  add_rates(headings, 0, 1000 * kMs, 1);
  EXPECT_TRUE(heading_at(headings, 900 * kMs, 0));
  EXPECT_TRUE(heading_at(headings, 950 * kMs, 1));
  add_rates(headings, 2000 * kMs, 3000 * kMs, 1);
  EXPECT_FALSE(heading_at(headings, 2100 * kMs, 0)) << "the heading differs by an unknown turn";
  EXPECT_NEAR(heading_at(headings, 2200 * kMs, 0).value() + 0.1, heading_at(headings, 2300 * kMs, 0).value(),
              1e-9);
  EXPECT_FALSE(heading_at(headings, 2300 * kMs, 1));
  EXPECT_TRUE(heading_at(headings, 2400 * kMs, 1));
  add_rates(headings, 4000 * kMs, 5000 * kMs, 1);
  EXPECT_FALSE(heading_at(headings, 3500 * kMs, 0)) << "the scan is in the gap";
  EXPECT_TRUE(heading_at(headings, 4100 * kMs, 0)) << "no turn follows from a scan without heading";
}

TEST(GyroscopeHeadings, ignores_faulty_rates_and_late_rates) {
  GyroscopeHeadings headings;
  add_rates(headings, 0, 100 * kMs, 1);
  headings.add_rate(110 * kMs, std::nan(""));
  headings.add_rate(115 * kMs, -std::numeric_limits<double>::infinity());
  headings.add_rate(116 * kMs, 1e30);
  headings.add_rate(100 * kMs, 7);  // a repeated message
  headings.add_rate(90 * kMs, 7);   // out of order
  headings.add_rate(120 * kMs, 1);
  EXPECT_NEAR(heading_at(headings, 120 * kMs).value(), 0.12, 1e-9);
}

TEST(GyroscopeHeadings, an_imu_that_reports_only_zero_gives_no_headings) {
  GyroscopeHeadings headings;
  add_rates(headings, 0, 1000 * kMs, 0);
  EXPECT_FALSE(heading_at(headings, 900 * kMs));
  headings.add_rate(1010 * kMs, 0.5);
  add_rates(headings, 1020 * kMs, 1100 * kMs, 0);
  EXPECT_TRUE(heading_at(headings, 950 * kMs));
  EXPECT_TRUE(heading_at(headings, 1050 * kMs));
}

TEST(GyroscopeHeadings, a_clock_that_was_set_back_is_a_gap) {
  GyroscopeHeadings headings;
  add_rates(headings, 10'000 * kMs, 11'000 * kMs, 1);
  EXPECT_TRUE(heading_at(headings, 10'900 * kMs));
  headings.add_scan(scan_at(11'050 * kMs));
  add_rates(headings, 0, 1000 * kMs, -1);
  headings.add_scan(scan_at(100 * kMs));
  EXPECT_FALSE(headings.take()->imu_heading_rad);
  const auto first = headings.take()->imu_heading_rad;
  ASSERT_TRUE(first) << "the scan before it has no heading";
  EXPECT_NEAR(heading_at(headings, 200 * kMs).value() - *first, -0.1, 1e-9);
}

TEST(GyroscopeHeadings, gyroscopes_with_another_clock_do_not_hold_scans_up) {
  GyroscopeHeadings headings;
  std::size_t taken = 0;
  for (int i = 0; i < 100; ++i) {
    headings.add_rate(i * 100 * kMs, 1);
    headings.add_scan(scan_at(1'600'000'000'000'000 + i * 100 * kMs));
    while (const auto frame = headings.take()) {
      EXPECT_FALSE(frame->imu_heading_rad);
      ++taken;
    }
  }
  EXPECT_EQ(taken, 90U) << "a scan waits for one second";
}

TEST(VerticalRate, follows_from_the_mount_of_the_gyroscope) {
  const mrpt::math::TVector3D rate{0.1, 0.2, 0.3};
  const auto mounted = [&](double yaw, double pitch, double roll) {
    return vertical_rate_radps(mrpt::poses::CPose3D(1, 2, 3, yaw, pitch, roll), rate);
  };
  EXPECT_NEAR(mounted(0.7, 0, 0), 0.3, 1e-12);
  EXPECT_NEAR(mounted(0.7, 0, M_PI), -0.3, 1e-12) << "upside down";
  EXPECT_NEAR(mounted(0.7, 0, M_PI / 2), 0.2, 1e-12) << "the y axis points up";
  EXPECT_NEAR(mounted(0.7, -M_PI / 2, 0), 0.1, 1e-12) << "the x axis points up";
}

TEST(VerticalRate, needs_no_rates_about_horizontal_axes) {
  const double nan = std::nan("");
  EXPECT_EQ(vertical_rate_radps({}, {nan, nan, 0.3}), 0.3);
  EXPECT_TRUE(std::isnan(vertical_rate_radps({0, 0, 0, 0, 0.2, 0}, {nan, 0, 0.3})));
}

}  // namespace
}  // namespace psi_slam
