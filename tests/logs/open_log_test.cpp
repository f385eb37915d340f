// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include "log_files.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

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
      ", expected a CARMEN log or an MRPT .rawlog, plain or gzipped, or a ROS bag (.bag, .db3, .mcap, or the "
      "folder of a ROS 2 bag)";
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

}  // namespace
}  // namespace psi_slam
