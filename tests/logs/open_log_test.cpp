// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "bag_files.h"
#include "log_files.h"
#include "rawlog_files.h"
#include "shared_logs.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::string small_carmen_log(int scans) {
  std::string log = "# a comment\n";
  for (int i = 0; i < scans; ++i) {
    log += "FLASER 181";
    for (int beam = 0; beam < 181; ++beam) log += " " + std::to_string(1 + (i + beam) % 9) + ".25";
    const std::string pose = " " + std::to_string(i) + " 0.5 0.25";
    log += pose + pose + " " + std::to_string(100 + i) + ".000001 host 1\n";
  }
  return log;
}

void expect_same_frames(const std::vector<Frame>& a, const std::vector<Frame>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].index, b[i].index);
    EXPECT_EQ(a[i].time_us, b[i].time_us);
    EXPECT_EQ(a[i].odom_T_robot, b[i].odom_T_robot);
    EXPECT_EQ(a[i].scan.ranges_m, b[i].scan.ranges_m);
    EXPECT_EQ(*a[i].scan.bearings_rad, *b[i].scan.bearings_rad);
  }
}

TEST(OpenLog, reads_carmen_plain_and_gzipped_alike) {
  const TemporaryFolder folder;
  const std::string log = small_carmen_log(20);
  write_file(folder.path() / "a.rawlog", log);
  write_gzipped(folder.path() / "b.txt", log);
  const auto plain = frames_of(folder.path() / "a.rawlog");
  ASSERT_EQ(plain.size(), 20U);
  EXPECT_EQ(plain[19].time_us, 119'000'001);
  expect_same_frames(plain, frames_of(folder.path() / "b.txt"));
}

TEST(OpenLog, every_nth_scan_keeps_its_own_odometry) {
  const TemporaryFolder folder;
  write_file(folder.path() / "log", small_carmen_log(10));
  LogOptions options;
  options.every_nth_scan = 4;
  const auto frames = frames_of(folder.path() / "log", options);
  ASSERT_EQ(frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].odom_T_robot.x, 4.0 * static_cast<double>(i));
    EXPECT_EQ(frames[i].time_us, static_cast<TimeUs>(100 + 4 * i) * 1'000'000 + 1);
  }
}

TEST(OpenLog, rejects_invalid_options) {
  const TemporaryFolder folder;
  write_file(folder.path() / "log", small_carmen_log(1));
  LogOptions options;
  options.every_nth_scan = 0;
  EXPECT_EQ(sentence_of([&] { open_log(folder.path() / "log", options); }),
            "log.every_nth_scan is 0, expected 1 or more");
}

TEST(OpenLog, rejects_a_gyroscope_of_a_log_that_holds_none) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  write_file(path, small_carmen_log(1));
  LogOptions options;
  options.imu = "/imu";
  EXPECT_EQ(sentence_of([&] { open_log(path, options); }), "log.imu is \"/imu\", expected auto or none for " +
                                                               path.string() +
                                                               ", because CARMEN logs hold no gyroscope");
}

TEST(OpenLog, reports_missing_and_empty_files) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const std::string expected =
      ", expected a CARMEN log or an MRPT .rawlog, plain or compressed, or a ROS bag (.bag, .db3, .mcap, or "
      "the folder of a ROS 2 bag)";
  EXPECT_EQ(sentence_of([&] { open_log(path); }),
            path.string() + " does not exist, expected a log. Check the path");
  write_file(path, "");
  EXPECT_EQ(sentence_of([&] { open_log(path); }),
            path.string() + " is empty" + expected + ". Fetch or record it again");
}

TEST(OpenLog, reports_a_truncated_gzip_file) {
  const auto whole = shared_file("mit-csail.clf.gz");
  if (!whole) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const auto path = folder.path() / "cut.clf.gz";
  write_file(path, read_file(*whole).substr(0, 400'000));
  EXPECT_EQ(sentence_of([&] { frames_of(path); }),
            path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

TEST(OpenLog, yields_the_scans_before_the_end_of_a_truncated_gzip_file) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "cut.clf.gz";
  write_gzipped(path, small_carmen_log(300));
  const std::string whole = read_file(path);
  write_file(path, whole.substr(0, whole.size() / 2));
  const auto log = open_log(path);
  std::size_t scans = 0;
  EXPECT_EQ(sentence_of([&] {
              while (log->next()) ++scans;
            }),
            path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
  EXPECT_GT(scans, 50U);
}

/// A log of a laser that is stated to see 8.19 m, and writes 8.18 m for each reading of more than 6 m.
struct LogWithCodes {
  static constexpr float kCode_m = 8.18F;

  LogWithCodes() {
    const SimulatedRun run = round_trips(1);
    for (std::size_t i = 0; i < 250; ++i) {
      const TimeUs time_us = 1'600'000'000'000'000 + static_cast<TimeUs>(200'000 * i);
      const TPose2D& pose = run.odometry[i];
      RecordedPose wheels{"/odom", time_us, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}};
      RecordedScan scan;
      scan.time_us = time_us;
      scan.angle_min_rad = run.bearings_rad.front();
      scan.angle_increment_rad = run.bearings_rad[1] - run.bearings_rad[0];
      scan.range_max_m = 8.19F;
      scan.ranges_m = run.ranges_m(i);
      for (float& range_m : scan.ranges_m) {
        if (range_m <= 6) continue;
        range_m = kCode_m;
        ++codes;
      }
      auto observation = range_scan(time_us, "LASER", scan.ranges_m);
      observation->maxRange = scan.range_max_m;
      objects.push_back(observation);
      objects.push_back(odometry(time_us, mrpt::poses::CPose2D(pose)));
      recording.emplace_back(wheels);
      recording.emplace_back(scan);
    }
  }

  Recording recording{static_mount()};
  RawlogObjects objects;
  std::ptrdiff_t codes = 0;  // number of readings
};

TEST(OpenLog, codes_for_no_return_are_no_returns_in_logs_of_each_format) {
  const TemporaryFolder folder;
  const LogWithCodes log;
  const auto path = [&](const char* name) { return folder.path() / name; };
  write_carmen(path("a.log"), log.recording);
  write_mcap(path("a.mcap"), log.recording);
  write_db3(path("a.db3"), log.recording);
  write_rawlog(path("a.rawlog"), log.objects);
  for (const char* name : {"a.log", "a.mcap", "a.db3", "a.rawlog"}) {
    SCOPED_TRACE(name);
    std::ptrdiff_t no_returns = 0;
    const auto source = open_log(path(name));
    const std::vector<Frame> frames = all_frames(*source);
    EXPECT_GE(frames.size(), 249U);
    for (const Frame& frame : frames) {
      EXPECT_EQ(frame.scan.max_range_m, 8.175F);
      no_returns += std::count(frame.scan.ranges_m.begin(), frame.scan.ranges_m.end(), HUGE_VALF);
    }
    EXPECT_GT(no_returns, log.codes * 9 / 10);
    EXPECT_LE(no_returns, log.codes);
    EXPECT_THAT(source->assumptions(), testing::Contains(testing::HasSubstr("writes 8.18 m")));
    LogOptions options;
    options.max_range_m = 8.19;
    const auto overruled = open_log(path(name), options);
    const auto frame = overruled->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->scan.max_range_m, 8.19F);
    EXPECT_THAT(frame->scan.ranges_m, testing::Contains(LogWithCodes::kCode_m));
    EXPECT_THAT(overruled->assumptions(), testing::Not(testing::Contains(testing::HasSubstr("writes"))));
  }
}

TEST(OpenLog, the_maximum_range_of_a_log_that_states_none_is_50_m_or_a_longer_code) {
  const TemporaryFolder folder;
  SimulatedRun run = round_trips(1);
  write_file(folder.path() / "short", carmen_log(run));
  run.put_into = [](std::vector<float>& ranges_m, std::size_t) {
    for (float& range_m : ranges_m)
      if (range_m > 6) range_m = 81.91F;
  };
  write_file(folder.path() / "long", carmen_log(run));
  EXPECT_EQ(frames_of(folder.path() / "short").front().scan.max_range_m, 50);
  const auto source = open_log(folder.path() / "long");
  EXPECT_EQ(source->next()->scan.max_range_m, 81.905F);
  EXPECT_THAT(source->assumptions(), testing::IsEmpty());
}

}  // namespace
}  // namespace psi_slam
