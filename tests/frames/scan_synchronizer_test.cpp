// SPDX-License-Identifier: BSD-3-Clause
#include "frames/scan_synchronizer.h"

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

/// The frames, "laser@ms" for each scan; `left_out` becomes the number of scans in none.
std::vector<std::string> united(const std::vector<Stamp>& stamps, std::size_t* left_out = nullptr) {
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
  if (left_out != nullptr) *left_out = synchronizer.left_out();
  return frames;
}

using testing::ElementsAre;

TEST(ScanSynchronizer, the_nearest_scan_of_each_other_laser_joins) {
  EXPECT_THAT(united({{0, 0}, {1, 30}, {2, 40}, {0, 100}, {1, 130}, {2, 140}}),
              ElementsAre("0@0 1@30 2@40", "0@100 1@130 2@140"));
  EXPECT_THAT(united({{0, 0}, {1, 70}, {0, 100}, {1, 170}, {0, 200}}),
              ElementsAre("0@0", "0@100 1@70", "0@200 1@170"));
}

TEST(ScanSynchronizer, tells_where_the_robot_was_when_the_other_laser_scanned) {
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
    EXPECT_EQ(synchronizer.left_out(), 1U);
    EXPECT_FALSE(synchronizer.take());
  }
}

TEST(ScanSynchronizer, without_odometry_nothing_is_moved) {
  ScanSynchronizer synchronizer;
  synchronizer.add(scan_of({0, 0}));
  Frame other = scan_of({1, 50});
  other.has_odometry = false;
  synchronizer.add(other);
  synchronizer.end_of_log();
  EXPECT_EQ(synchronizer.take()->companions.at(0).frame_T_robot, TPose2D(0, 0, 0));
}

TEST(ScanSynchronizer, a_faster_laser_has_scans_to_spare) {
  std::size_t left_out = 0;
  EXPECT_THAT(united({{0, 0}, {1, 5}, {1, 30}, {1, 55}, {1, 80}, {0, 100}, {1, 105}}, &left_out),
              ElementsAre("0@0 1@5", "0@100 1@105"));
  EXPECT_EQ(left_out, 3U);
}

/// Ten a second each, the second laser half a period later, both with stamps up to 8 ms off.
std::vector<Stamp> half_a_period_apart(unsigned seed) {
  std::vector<Stamp> stamps;
  std::mt19937 random(seed);
  for (int i = 0; i < 400; ++i)
    for (const int laser : {0, 1})
      stamps.push_back(
          {static_cast<std::size_t>(laser), 100 * i + laser * 50 + static_cast<int>(random() % 17) - 8});
  return stamps;
}

TEST(ScanSynchronizer, of_lasers_half_a_period_apart_no_scan_is_lost_but_at_an_end) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::size_t left_out = 0;
    const auto frames = united(half_a_period_apart(seed), &left_out);
    EXPECT_LE(left_out, 1U);
    EXPECT_EQ(frames.size(), 400U) << "one of each scan of the first laser";
    std::size_t alone = 0;
    for (const std::string& frame : frames) alone += frame.find(" 1@") == std::string::npos ? 1 : 0;
    EXPECT_LE(alone, 1U);
  }
}

TEST(ScanSynchronizer, a_detour_ends_though_no_frame_without_a_scan_comes) {
  std::vector<Stamp> stamps{{1, -50}};  // belongs to the first frame, which has a nearer one
  for (int i = 0; i < 30; ++i) stamps.insert(stamps.end(), {{0, 100 * i}, {1, 100 * i + 40}});
  std::size_t left_out = 0;
  const auto frames = united(stamps, &left_out);
  EXPECT_EQ(left_out, 1U);
  EXPECT_EQ(frames[0], "0@0 1@-50");
  EXPECT_EQ(frames[3], "0@300 1@240") << "20 ms farther than the nearest";
  EXPECT_EQ(frames[20], "0@2000 1@2040");
}

TEST(ScanSynchronizer, what_lies_far_from_all_scans_of_lasers_before_is_a_frame_of_its_own) {
  std::size_t left_out = 0;
  EXPECT_THAT(
      united({{0, 0}, {1, 10}, {1, 210}, {2, 230}, {1, 410}, {2, 430}, {0, 600}, {1, 610}}, &left_out),
      ElementsAre("0@0 1@10", "1@210 2@230", "1@410 2@430", "0@600 1@610"));
  EXPECT_EQ(left_out, 0U);
}

TEST(ScanSynchronizer, messages_may_come_in_another_order_than_they_were_stamped) {
  EXPECT_THAT(united({{1, 20}, {0, 0}, {0, 100}, {0, 200}, {1, 120}, {1, 220}, {0, 300}}),
              ElementsAre("0@0 1@20", "0@100 1@120", "0@200 1@220", "0@300"));
}

TEST(ScanSynchronizer, scans_before_and_after_the_clock_was_set_are_strangers) {
  EXPECT_THAT(united({{0, 5000}, {1, 5010}, {0, 5100}, {1, 100}, {0, 110}, {0, 210}, {1, 200}}),
              ElementsAre("0@5000 1@5010", "0@5100", "0@110 1@100", "0@210 1@200"));
}

TEST(ScanSynchronizer, where_stamps_say_nothing_the_order_of_the_log_decides) {
  EXPECT_THAT(united({{0, 7}, {1, 7}, {0, 7}, {1, 7}}), ElementsAre("0@7 1@7", "0@7 1@7"));
}

TEST(ScanSynchronizer, does_not_wait_for_ever_for_time_to_pass) {
  ScanSynchronizer synchronizer;
  for (std::size_t i = 0; i <= ScanSynchronizer::kMostWaiting; ++i) {
    EXPECT_FALSE(synchronizer.take());
    synchronizer.add(scan_of({0, 0}));
  }
  EXPECT_TRUE(synchronizer.take());
  EXPECT_FALSE(synchronizer.take());
}

TEST(ScanSynchronizer, one_laser_alone_passes) {
  EXPECT_THAT(united({{0, 0}, {0, 10}, {0, 5}, {0, 900}}), ElementsAre("0@0", "0@10", "0@5", "0@900"));
  EXPECT_THAT(united({{1, 0}, {1, 10}}), ElementsAre("1@0", "1@10"));
}

}  // namespace
}  // namespace psi_slam
