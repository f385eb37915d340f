// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/entry_frames.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "rawlog_files.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<double> ways_m(EntryFrames& entries) {
  std::vector<double> ways_m;
  while (const std::optional<Frame> frame = entries.next()) {
    EXPECT_EQ(frame->index, ways_m.size());
    ways_m.push_back(frame->odom_T_robot.x);
  }
  return ways_m;
}

TEST(EntryFrames, sum_up_actions) {
  EntryFrames entries{LogOptions()};
  entries.take(movement({1, 0, 0}), sensory_frame({range_scan(1'000'000)}), nullptr);
  entries.take(movement({0.5, 0, 0}), sensory_frame({range_scan(2'000'000)}), nullptr);
  EXPECT_THAT(ways_m(entries), ElementsAre(1, 1.5));
}

TEST(EntryFrames, wait_for_the_next_odometry) {
  EntryFrames entries{LogOptions()};
  entries.take(nullptr, nullptr, odometry(1'000'000, {1, 0, 0}));
  entries.take(nullptr, nullptr, range_scan(1'500'000));
  EXPECT_EQ(entries.scans(), 1u);
  EXPECT_FALSE(entries.next());
  entries.take(nullptr, nullptr, odometry(2'000'000, {2, 0, 0}));
  EXPECT_THAT(ways_m(entries), ElementsAre(1.5));
}

TEST(EntryFrames, before_the_first_action_are_at_the_start) {
  EntryFrames entries{LogOptions()};
  entries.take(nullptr, nullptr, range_scan(1'000'000));
  entries.take(movement({1, 0, 0}), sensory_frame({range_scan(2'000'000)}), nullptr);
  EXPECT_THAT(ways_m(entries), ElementsAre(0, 1));
}

TEST(EntryFrames, have_a_maximum_range_if_the_observations_state_none) {
  auto scan = range_scan(1'000'000);
  scan->maxRange = 0;
  for (std::size_t i = 0; i < scan->getScanSize(); ++i) scan->setScanRange(i, i == 0 ? 60 : 2);
  EntryFrames entries{LogOptions()};
  entries.take(movement({1, 0, 0}), sensory_frame({scan}), nullptr);
  const std::optional<Frame> frame = entries.next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->scan.max_range_m, 50);
  EXPECT_TRUE(std::isinf(frame->scan.ranges_m.front()));
  EXPECT_EQ(frame->scan.ranges_m.back(), 2);
}

// Each scan sees walls at other distances; beams that hit nothing read 8.18 m, though 8.19 m is stated.
TEST(EntryFrames, learn_the_code_for_no_return) {
  LogOptions stated;
  stated.max_range_m = 8.19;
  EntryFrames entries{LogOptions()};
  EntryFrames overruled{stated};
  std::optional<Frame> last;
  std::optional<Frame> last_overruled;
  for (int k = 0; k < 40; ++k) {
    auto scan = range_scan(1'000'000 * (k + 1));
    scan->maxRange = 8.19F;
    for (std::size_t i = 0; i < scan->getScanSize(); ++i)
      scan->setScanRange(i, i % 2 == 0 ? 8.18F : 1 + 0.1F * static_cast<float>((k * 7) % 23));
    for (EntryFrames* all : {&entries, &overruled})
      all->take(movement({0.1, 0, 0}), sensory_frame({scan}), nullptr);
    last = entries.next();
    last_overruled = overruled.next();
  }
  ASSERT_TRUE(last && last_overruled);
  EXPECT_TRUE(std::isinf(last->scan.ranges_m.front()));
  EXPECT_NEAR(last_overruled->scan.ranges_m.front(), 8.18F, 1e-6);
}

TEST(EntryFrames, are_of_one_laser) {
  EntryFrames entries{LogOptions()};
  entries.take(movement({1, 0, 0}),
               sensory_frame({range_scan(1'000'000, "FRONT"), range_scan(1'000'000, "REAR")}), nullptr);
  EXPECT_EQ(entries.scans(), 1u);
}

TEST(EntryFrames, need_no_odometry) {
  EntryFrames entries{LogOptions()};
  entries.take(nullptr, nullptr, range_scan(1'000'000));
  EXPECT_FALSE(entries.next()) << "odometry may still come";
  entries.end_of_log();
  const auto frame = entries.next();
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->has_odometry);
}

TEST(EntryFrames, wait_for_odometry_for_a_thousand_scans) {
  EntryFrames entries{LogOptions()};
  for (TimeUs i = 1; i <= 1000; ++i) entries.take(nullptr, nullptr, range_scan(i * 100'000));
  EXPECT_FALSE(entries.next());
  entries.take(nullptr, nullptr, range_scan(1001 * 100'000));
  std::size_t frames = 0;
  while (entries.next()) ++frames;
  EXPECT_EQ(frames, 1001U);
}

TEST(EntryFrames, skip_odometry_that_is_not_finite) {
  EntryFrames entries{LogOptions()};
  entries.take(movement({1, 0, 0}), sensory_frame({range_scan(1'000'000)}), nullptr);
  entries.take(movement({std::nan(""), 0, 0}), sensory_frame({range_scan(2'000'000)}), nullptr);
  EXPECT_TRUE(entries.next()->has_odometry);
  EXPECT_FALSE(entries.next()->has_odometry);
  EXPECT_EQ(entries.skipped().sentence(),
            "1 message of the log is unusable and skipped: entries: action 2: the odometry is not finite, or "
            "beyond 10,000 km");
}

TEST(EntryFrames, a_scan_without_time_is_refused) {
  EntryFrames entries{LogOptions()};
  const auto scan = range_scan(1'000'000);
  scan->timestamp = {};
  EXPECT_EQ(sentence_of([&] { entries.take(nullptr, nullptr, scan); }),
            "entries: observation 1: the scan has no time stamp, expected one on every observation. "
            "Record the log with time stamps");
}

TEST(EntryFrames, of_two_lasers_hold_the_scans_of_both) {
  LogOptions options;
  options.laser = "all";
  EntryFrames entries(options);
  const auto rear = [](TimeUs time_us) {
    auto scan = range_scan(time_us, "REAR");
    scan->sensorPose = mrpt::poses::CPose3D(-0.3, 0, 0, M_PI, 0, 0);
    return scan;
  };
  for (TimeUs t = 0; t < 4; ++t) {
    const TimeUs time_us = 1'000'000 + t * 100'000;
    entries.take(nullptr, nullptr, odometry(time_us, {0.1 * static_cast<double>(t), 0, 0}));
    entries.take(nullptr, nullptr, range_scan(time_us, "FRONT"));
    if (t != 1) entries.take(nullptr, nullptr, rear(time_us + 50'000));
  }
  entries.take(nullptr, nullptr, odometry(1'400'000, {0.4, 0, 0}));
  EXPECT_EQ(entries.scans(), 7u);
  entries.end_of_log();
  std::vector<std::size_t> opened_by;
  std::vector<std::size_t> companions;
  while (const std::optional<Frame> frame = entries.next()) {
    EXPECT_EQ(frame->index, opened_by.size());
    opened_by.push_back(entries.opened_by());
    companions.push_back(frame->companions.size());
    for (const CompanionScan& companion : frame->companions)
      EXPECT_NEAR(companion.frame_T_robot.x, 0.05, 1e-9);
  }
  EXPECT_THAT(opened_by, ElementsAre(0, 2, 3, 5));
  EXPECT_THAT(companions, ElementsAre(1, 0, 1, 1));
}

}  // namespace
}  // namespace psi_slam
