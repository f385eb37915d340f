// SPDX-License-Identifier: BSD-3-Clause
// A recording of a few scans for tests of the files of sessions.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "session/session_recording.h"

namespace psi_slam {

template <class Number>
bool same_bits(Number a, Number b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline LaserScan scan_of(std::vector<float> ranges_m, float max_range_m) {
  LaserScan scan;
  scan.bearings_rad = std::make_shared<std::vector<float>>(ranges_m.size(), 0.1F);
  scan.ranges_m = std::move(ranges_m);
  scan.max_range_m = max_range_m;
  scan.robot_T_laser = {0.1, -1e-300, M_PI};
  scan.sweep_time_s = 0.025F;
  return scan;
}

/// Returns a scan of a second laser. For frame 2, adds a scan of a third laser.
inline std::vector<CompanionScan> companions_of(std::size_t frame) {
  std::vector<CompanionScan> companions(frame == 2 ? 2 : 1);
  for (std::size_t i = 0; i < companions.size(); ++i) {
    companions[i].scan = scan_of(std::vector<float>(i + 2, 2.2F), 40);
    companions[i].scan.laser = i + 1;
    companions[i].time_us = 17 + static_cast<TimeUs>(frame);
    companions[i].frame_T_robot = {1.0 / 7, -0.0, 1e-300};
  }
  return companions;
}

/// Returns a recording with scans of up to three lasers and with numbers that a text would round.
inline SessionRecording small_recording() {
  SessionRecording recording;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < 4; ++i) {
    Frame frame;
    frame.index = i;
    frame.time_us = 1'000'000'000'000'007 - static_cast<TimeUs>(i);  // time stamps run backwards
    frame.odom_T_robot = {1.0 / 3, -0.0, std::nextafter(M_PI, 0)};
    frame.scan = i < 2 ? scan_of({1.1F, nan, INFINITY, 3.3F}, 80) : scan_of({0.1F}, 30);
    frame.has_odometry = i != 3;
    if (i > 1) frame.imu_heading_rad = -1.0 / 3;
    if (i > 0) frame.companions = companions_of(i);
    recording.frames.push_back(frame);
  }
  recording.facts.program_version = "0.1.0";
  recording.facts.logs = {{"first.log", std::string(64, 'a'), 3}, {"zweiter \"Lauf\".log", "", 1}};
  recording.facts.runs = {{2, {17, {0.1, 1.0 / 3, -1e-17}, {2.0 / 3, -0.0, 1e-300}}}};
  recording.facts.settings = "[run]\nseed = 7\n";
  recording.facts.edits.add({{LoopEdit::Kind::kDelete, 2, 1}, {EditTime::Kind::kAfterScan, 3}});
  recording.facts.logs[0].skipped = {2, "first.log:7: no number", 5};
  recording.facts.logs[0].broken_off = "first.log:9 is cut off";
  recording.facts.logs[1].scans_left = true;
  return recording;
}

inline void expect_same_scan(const LaserScan& a, const LaserScan& b) {
  EXPECT_EQ(a.laser, b.laser);
  EXPECT_TRUE(same_bits(a.robot_T_laser, b.robot_T_laser));
  EXPECT_EQ(a.max_range_m, b.max_range_m);
  EXPECT_EQ(a.sweep_time_s, b.sweep_time_s);
  EXPECT_EQ(*a.bearings_rad, *b.bearings_rad);
  ASSERT_EQ(a.ranges_m.size(), b.ranges_m.size());
  for (std::size_t beam = 0; beam < a.ranges_m.size(); ++beam)
    EXPECT_TRUE(same_bits(a.ranges_m[beam], b.ranges_m[beam]));
}

inline void expect_same_frame(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.time_us, b.time_us);
  EXPECT_EQ(a.has_odometry, b.has_odometry);
  EXPECT_EQ(a.imu_heading_rad, b.imu_heading_rad);
  EXPECT_TRUE(same_bits(a.odom_T_robot, b.odom_T_robot));
  expect_same_scan(a.scan, b.scan);
  ASSERT_EQ(a.companions.size(), b.companions.size());
  for (std::size_t other = 0; other < a.companions.size(); ++other) {
    EXPECT_EQ(a.companions[other].time_us, b.companions[other].time_us);
    EXPECT_TRUE(same_bits(a.companions[other].frame_T_robot, b.companions[other].frame_T_robot));
    expect_same_scan(a.companions[other].scan, b.companions[other].scan);
  }
}

}  // namespace psi_slam
