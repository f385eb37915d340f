// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_synchronizer.h"

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Stamp {
  std::size_t laser;
  int ms;
};

Frame scan_of(const Stamp& stamp) {
  Frame frame;
  frame.time_us = 5'000'000 + TimeUs{1000} * stamp.ms;
  frame.odom_T_robot = {0.001 * stamp.ms, 0, 0};
  frame.scan.laser = stamp.laser;
  return frame;
}

std::string text(const Frame& frame) {
  const auto one = [](std::size_t laser, TimeUs time_us) {
    return std::to_string(laser) + "@" + std::to_string((time_us - 5'000'000) / 1000);
  };
  std::string all = one(frame.scan.laser, frame.time_us);
  for (const CompanionScan& companion : frame.companions)
    all += " " + one(companion.scan.laser, companion.time_us);
  return all;
}

/// Combines scans and returns the frames as text, "laser@ms" for each scan. Sets `spare` to the number of
/// scans that joined no frame.
std::vector<std::string> synchronized(const std::vector<Stamp>& stamps, std::size_t* spare = nullptr) {
  ScanSynchronizer synchronizer;
  std::vector<std::string> frames;
  const auto take = [&] {
    while (const auto frame = synchronizer.take()) frames.push_back(text(*frame));
  };
  for (const Stamp& stamp : stamps) {
    synchronizer.add(scan_of(stamp));
    take();
  }
  synchronizer.end_of_log();
  take();
  if (spare != nullptr) *spare = synchronizer.spare_scans();
  return frames;
}

using testing::ElementsAre;

TEST(ScanSynchronizer, the_nearest_scan_of_each_other_laser_joins) {
  EXPECT_THAT(synchronized({{0, 0}, {1, 30}, {2, 40}, {0, 100}, {1, 130}, {2, 140}}),
              ElementsAre("0@0 1@30 2@40", "0@100 1@130 2@140"));
  EXPECT_THAT(synchronized({{0, 0}, {1, 70}, {0, 100}, {1, 170}, {0, 200}}),
              ElementsAre("0@0", "0@100 1@70", "0@200 1@170"));
}

TEST(ScanSynchronizer, companion_holds_the_motion_between_the_scans) {
  ScanSynchronizer synchronizer;
  Frame first = scan_of({0, 0});
  first.odom_T_robot = {1, 2, M_PI / 2};
  Frame other = scan_of({1, 50});
  other.odom_T_robot = {1, 2.5, M_PI / 2 + 0.1};
  synchronizer.add(first);
  synchronizer.add(other);
  synchronizer.end_of_log();
  const TPose2D moved = synchronizer.take()->companions.at(0).frame_T_robot;
  EXPECT_NEAR(moved.x, 0.5, 1e-12);
  EXPECT_NEAR(moved.y, 0, 1e-12);
  EXPECT_NEAR(moved.phi, 0.1, 1e-12);
}

TEST(ScanSynchronizer, a_scan_beyond_a_jump_of_odometry_does_not_join) {
  for (const TPose2D& jump : {TPose2D(50, 0, 0), TPose2D(0, 0, 2)}) {
    ScanSynchronizer synchronizer;
    synchronizer.add(scan_of({0, 0}));
    Frame other = scan_of({1, 50});
    other.odom_T_robot = jump;
    synchronizer.add(other);
    synchronizer.end_of_log();
    EXPECT_TRUE(synchronizer.take()->companions.empty());
    EXPECT_EQ(synchronizer.spare_scans(), 1U);
    EXPECT_FALSE(synchronizer.take());
  }
}

TEST(ScanSynchronizer, without_odometry_the_motion_is_zero) {
  ScanSynchronizer synchronizer;
  synchronizer.add(scan_of({0, 0}));
  Frame other = scan_of({1, 50});
  other.has_odometry = false;
  synchronizer.add(other);
  synchronizer.end_of_log();
  EXPECT_EQ(synchronizer.take()->companions.at(0).frame_T_robot, TPose2D(0, 0, 0));
}

TEST(ScanSynchronizer, without_odometry_a_gyroscope_gives_the_turn) {
  ScanSynchronizer synchronizer;
  Frame first = scan_of({0, 0});
  Frame other = scan_of({1, 50});
  for (Frame* frame : {&first, &other}) frame->has_odometry = false;
  first.imu_heading_rad = 7.0;
  other.imu_heading_rad = 7.125;
  synchronizer.add(first);
  synchronizer.add(other);
  synchronizer.end_of_log();
  EXPECT_EQ(synchronizer.take()->companions.at(0).frame_T_robot, TPose2D(0, 0, 0.125));
}

TEST(ScanSynchronizer, a_faster_laser_has_scans_to_spare) {
  std::size_t spare = 0;
  EXPECT_THAT(synchronized({{0, 0}, {1, 5}, {1, 30}, {1, 55}, {1, 80}, {0, 100}, {1, 105}}, &spare),
              ElementsAre("0@0 1@5", "0@100 1@105"));
  EXPECT_EQ(spare, 3U);
}

/// Ten scans a second of each laser, the second laser half a period after the first. Time stamps deviate by
/// up to 8 ms.
std::vector<Stamp> half_a_period_apart(unsigned seed) {
  std::vector<Stamp> stamps;
  std::mt19937 random(seed);
  for (int i = 0; i < 400; ++i)
    for (const int laser : {0, 1})
      stamps.push_back(
          {static_cast<std::size_t>(laser), 100 * i + laser * 50 + static_cast<int>(random() % 17) - 8});
  return stamps;
}

TEST(ScanSynchronizer, lasers_half_a_period_apart_lose_at_most_one_scan) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::size_t spare = 0;
    const auto frames = synchronized(half_a_period_apart(seed), &spare);
    EXPECT_LE(spare, 1U);
    EXPECT_EQ(frames.size(), 400U) << "one frame for each scan of the first laser";
    std::size_t alone = 0;
    for (const std::string& frame : frames) alone += frame.find(" 1@") == std::string::npos ? 1 : 0;
    EXPECT_LE(alone, 1U);
  }
}

TEST(ScanSynchronizer, detours_end_without_a_frame_that_lacks_a_scan) {
  std::vector<Stamp> stamps{{1, -50}};  // the scan at 40 ms is nearer to the first frame
  for (int i = 0; i < 30; ++i) stamps.insert(stamps.end(), {{0, 100 * i}, {1, 100 * i + 40}});
  std::size_t spare = 0;
  const auto frames = synchronized(stamps, &spare);
  EXPECT_EQ(spare, 1U);
  EXPECT_EQ(frames[0], "0@0 1@-50");
  EXPECT_EQ(frames[3], "0@300 1@240") << "the scan at 240 ms is 20 ms farther than the scan at 340 ms";
  EXPECT_EQ(frames[20], "0@2000 1@2040");
}

TEST(ScanSynchronizer, a_scan_far_from_all_scans_of_earlier_lasers_opens_a_frame) {
  std::size_t spare = 0;
  EXPECT_THAT(
      synchronized({{0, 0}, {1, 10}, {1, 210}, {2, 230}, {1, 410}, {2, 430}, {0, 600}, {1, 610}}, &spare),
      ElementsAre("0@0 1@10", "1@210 2@230", "1@410 2@430", "0@600 1@610"));
  EXPECT_EQ(spare, 0U);
}

TEST(ScanSynchronizer, messages_may_arrive_out_of_order) {
  EXPECT_THAT(synchronized({{1, 20}, {0, 0}, {0, 100}, {0, 200}, {1, 120}, {1, 220}, {0, 300}}),
              ElementsAre("0@0 1@20", "0@100 1@120", "0@200 1@220", "0@300"));
}

TEST(ScanSynchronizer, scans_before_and_after_a_clock_change_share_no_frame) {
  EXPECT_THAT(synchronized({{0, 5000}, {1, 5010}, {0, 5100}, {1, 100}, {0, 110}, {0, 210}, {1, 200}}),
              ElementsAre("0@5000 1@5010", "0@5100", "0@110 1@100", "0@210 1@200"));
}

TEST(ScanSynchronizer, the_order_of_the_log_decides_between_equal_stamps) {
  EXPECT_THAT(synchronized({{0, 7}, {1, 7}, {0, 7}, {1, 7}}), ElementsAre("0@7 1@7", "0@7 1@7"));
}

TEST(ScanSynchronizer, stops_waiting_if_time_stands_still) {
  ScanSynchronizer synchronizer;
  for (std::size_t i = 0; i <= ScanSynchronizer::kMaxWaiting; ++i) {
    EXPECT_FALSE(synchronizer.take());
    synchronizer.add(scan_of({0, 0}));
  }
  EXPECT_TRUE(synchronizer.take());
  EXPECT_FALSE(synchronizer.take());
}

TEST(ScanSynchronizer, passes_a_single_laser_through) {
  EXPECT_THAT(synchronized({{0, 0}, {0, 10}, {0, 5}, {0, 900}}), ElementsAre("0@0", "0@10", "0@5", "0@900"));
  EXPECT_THAT(synchronized({{1, 0}, {1, 10}}), ElementsAre("1@0", "1@10"));
}

}  // namespace
}  // namespace psi_slam
