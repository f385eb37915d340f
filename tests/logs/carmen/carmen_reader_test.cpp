// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "log_files.h"
#include "logs/frames/log_reader.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::string flaser(const std::string& name, const std::string& pose, const std::string& odometry,
                   const std::string& time) {
  std::string text = name + " 181";
  for (int i = 0; i < 181; ++i) text += " " + std::to_string(1 + i % 7) + ".5";
  return text + " " + pose + " " + odometry + " " + time + " approx 0.5\n";
}

const std::string kRawConfiguration = " 0 -1.5 3 1.5 30 0.01 0  3 1 2 3  0  ";

std::string rawlaser(const std::string& name, const std::string& time) {
  return name + kRawConfiguration + time + " host 0\n";
}

std::string robotlaser(const std::string& laser_pose, const std::string& robot_pose,
                       const std::string& time) {
  return "ROBOTLASER1" + kRawConfiguration + laser_pose + " " + robot_pose + " 0 0 0 0 0 " + time +
         " host 0\n";
}

std::string odom(const std::string& pose, const std::string& time) {
  return "ODOM " + pose + " 0 0 0 " + time + " host 0\n";
}

class CarmenReaderTest : public testing::Test {
 protected:
  std::vector<Frame> read(const std::string& log, const LogOptions& options = {}) {
    write_file(path_, log);
    const auto reader = open_carmen_log(path_, options);
    std::vector<Frame> frames = all_frames(*reader);
    EXPECT_EQ(reader->progress(), 1.0);
    EXPECT_FALSE(reader->next()) << "no frame after the end";
    contents_ = reader->contents();
    return frames;
  }

  std::string sentence_about(const std::string& log, const LogOptions& options = {}) {
    return sentence_of([&] { read(log, options); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
  LogContents contents_;
};

TEST_F(CarmenReaderTest, flaser_has_the_odometry_of_its_line) {
  const auto frames =
      read("# comment\n\n" + flaser("FLASER", "9 9 1", "1 2 -3", "976052905.167303") +
           odom("7 7 0", "976052905.2") + flaser("FLASER", "9 9 1", "1.5 2 3.1", "976052905.4"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].index, 0U);
  EXPECT_EQ(frames[0].time_us, 976052905167303);
  EXPECT_EQ(frames[0].odom_T_robot, (TPose2D{1, 2, -3}));
  EXPECT_EQ(frames[0].scan.ranges_m.size(), 181U);
  EXPECT_EQ(frames[0].scan.ranges_m[3], 4.5F);
  EXPECT_NEAR(frames[0].scan.bearings_rad->front(), -M_PI / 2, 1e-6);
  EXPECT_EQ(frames[0].scan.robot_T_laser, (TPose2D{0, 0, 0}))
      << "the mount is never derived from the poses of FLASER lines";
  EXPECT_EQ(frames[1].index, 1U);
  EXPECT_EQ(frames[1].time_us, 976052905400000);
  EXPECT_EQ(contents_.scans_with_two_poses, 2U);
}

TEST_F(CarmenReaderTest, tells_the_pose_of_the_laser_from_a_mapped_pose) {
  read(flaser("FLASER", "1.1 0 0", "1 0 0", "1") + flaser("FLASER", "2 0.1 1.5708", "2 0 1.5708", "2"));
  EXPECT_EQ(contents_.scans_with_two_poses, 2U);
  EXPECT_FALSE(contents_.second_pose_is_mapped);
  read(flaser("FLASER", "1 0 0", "1 0 0", "1") + flaser("FLASER", "2 0.1 1.5708", "2 0 1.5708", "2"));
  EXPECT_TRUE(contents_.second_pose_is_mapped);
  for (int odd = 0; odd < 8; ++odd) {
    std::string log;
    for (int i = 0; i < 8; ++i)
      log += flaser("FLASER", i == odd ? "0 0 0" : "1.1 0 0", "1 0 0", std::to_string(i));
    read(log);
    EXPECT_FALSE(contents_.second_pose_is_mapped) << "one odd scan: " << odd;
  }
}

TEST_F(CarmenReaderTest, reads_rlaser_if_selected_or_alone) {
  const std::string rear = flaser("RLASER", "0 0 0", "5 0 0", "2");
  const std::string log = flaser("FLASER", "0 0 0", "1 0 0", "1") + rear;
  EXPECT_EQ(read(log).at(0).odom_T_robot.x, 1);
  LogOptions options;
  options.laser = "rear";
  EXPECT_EQ(read(log, options).at(0).odom_T_robot.x, 5);
  EXPECT_EQ(read(rear).at(0).odom_T_robot.x, 5);
  EXPECT_NEAR(std::abs(read(rear).at(0).scan.robot_T_laser.phi), M_PI, 1e-12);
}

TEST_F(CarmenReaderTest, combines_lasers_whose_mounts_are_stated) {
  const std::string front = "PARAM robot_frontlaser_offset 0.2 host 1\n";
  const std::string rear = "PARAM robot_rearlaser_offset -0.3 host 1\n";
  const std::string scans =
      flaser("RLASER", "0 0 0", "1 0 0", "1") + flaser("FLASER", "0 0 0", "1 0 0", "1.1");
  const auto frames = read(front + rear + scans);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].scan.laser, 1U);
  EXPECT_EQ(frames[0].scan.robot_T_laser.x, -0.3);
  EXPECT_EQ(frames[1].scan.laser, 0U) << "the front laser opens frames";
  EXPECT_EQ(frames[1].scan.robot_T_laser.x, 0.2);
  EXPECT_TRUE(contents_.several_lasers);
  EXPECT_EQ(contents_.laser_names.front().front(), "FLASER");
  EXPECT_FALSE(contents_.states_beam_angles);
  EXPECT_THAT(contents_.assumptions,
              testing::ElementsAre("the scans of FLASER, RLASER are combined, because their mounts are "
                                   "stated. Select lasers with log.laser"));

  LogOptions mounts;
  mounts.laser_mounts = "front 0.2 0 0, RLASER -0.3 0 180";
  EXPECT_EQ(read(scans, mounts).size(), 2U);
  LogOptions single;
  single.robot_T_laser = TPose2D{0.1, 0, 0};
  EXPECT_EQ(read(front + rear + scans, single).size(), 1U);
  EXPECT_THAT(contents_.assumptions, testing::IsEmpty());
}

TEST_F(CarmenReaderTest, reads_one_laser_where_a_mount_is_unknown) {
  const std::string scans =
      flaser("RLASER", "0 0 0", "1 0 0", "1") + flaser("FLASER", "0 0 0", "1 0 0", "1.1");
  const std::string robotlaser1 = robotlaser("3 4 0.5", "3 4 0.5", "1");
  std::string robotlaser2 = robotlaser("3 4 0.5", "3 4 0.5", "2");
  robotlaser2.replace(0, 11, "ROBOTLASER2");
  for (const std::string& log :
       {scans, "PARAM robot_rearlaser_offset 0.2 host 1\n" + scans,
        "PARAM robot_frontlaser_offset 0.2 host 1\n" + scans, robotlaser1 + robotlaser2}) {
    EXPECT_EQ(read(log).size(), 1U);
    EXPECT_FALSE(contents_.several_lasers);
    ASSERT_EQ(contents_.assumptions.size(), 1U);
    EXPECT_THAT(contents_.assumptions[0],
                testing::HasSubstr("are not used, because no fixed and level mount of their own is stated."));
  }
}

TEST_F(CarmenReaderTest, interpolates_odometry_for_rawlaser) {
  const auto frames = read(rawlaser("RAWLASER1", "0.5") + odom("1 0 0", "1") + rawlaser("RAWLASER1", "1.25") +
                           odom("2 0 0.4", "2") + rawlaser("RAWLASER1", "2.5"));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].odom_T_robot, (TPose2D{1, 0, 0}));
  EXPECT_NEAR(frames[1].odom_T_robot.x, 1.25, 1e-12);
  EXPECT_NEAR(frames[1].odom_T_robot.phi, 0.1, 1e-12);
  EXPECT_EQ(frames[2].odom_T_robot, (TPose2D{2, 0, 0.4}));
  EXPECT_EQ(frames[2].time_us, 2'500'000);
  EXPECT_EQ(frames[2].index, 2U);
  EXPECT_EQ(frames[2].scan.max_range_m, 30);
  EXPECT_NEAR(frames[2].scan.bearings_rad->at(1), 0, 1e-6);
}

TEST_F(CarmenReaderTest, reads_each_numbered_rawlaser) {
  for (const std::string name : {"RAWLASER1", "RAWLASER2", "RAWLASER3", "RAWLASER4"}) {
    LogOptions options;
    options.laser = name;
    const std::string log = rawlaser("RAWLASER1", "1") + rawlaser("RAWLASER2", "2") +
                            rawlaser("RAWLASER3", "3") + rawlaser("RAWLASER4", "4") + odom("0 0 0", "1");
    const auto frames = read(log, options);
    ASSERT_EQ(frames.size(), 1U) << name;
    EXPECT_EQ(frames[0].time_us, (name.back() - '0') * 1'000'000) << name;
  }
}

TEST_F(CarmenReaderTest, reads_robotlaser_with_the_mount_of_a_raw_log) {
  const auto frames = read(robotlaser("1.2 0 0", "1 0 0", "1") + robotlaser("2.2 0 0", "2 0 0", "2"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].odom_T_robot, (TPose2D{2, 0, 0}));
  EXPECT_NEAR(frames[1].scan.robot_T_laser.x, 0.2, 1e-12);
}

TEST_F(CarmenReaderTest, takes_no_mount_from_corrected_robotlaser_lines) {
  const auto frames = read(robotlaser("1.2 0 0", "1 0 0", "1") + robotlaser("2.3 0.1 0", "2 0 0", "2"));
  EXPECT_EQ(frames.at(1).scan.robot_T_laser, (TPose2D{0, 0, 0}));
  EXPECT_EQ(frames.at(1).odom_T_robot, (TPose2D{2, 0, 0}));
}

TEST_F(CarmenReaderTest, prefers_robotlaser_to_rawlaser) {
  const auto frames =
      read(rawlaser("RAWLASER1", "1") + odom("0 0 0", "1") + robotlaser("1 0 0", "1 0 0", "1.5"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].time_us, 1'500'000);
}

TEST_F(CarmenReaderTest, uses_parameters_before_and_between_scans) {
  const auto frames =
      read("PARAM robot_frontlaser_offset 0.25 host 1\nPARAM robot_front_laser_max 5 host 1\n" +
           flaser("FLASER", "0 0 0", "0 0 0", "1") + "PARAM robot_frontlaser_offset 0.5 host 1\n" +
           flaser("FLASER", "0 0 0", "0 0 0", "2"));
  EXPECT_EQ(frames.at(0).scan.robot_T_laser.x, 0.25);
  EXPECT_EQ(frames.at(0).scan.max_range_m, 5);
  EXPECT_TRUE(std::isinf(frames.at(0).scan.ranges_m[5])) << "6.5 m is beyond the maximum range";
  EXPECT_TRUE(std::isfinite(frames.at(0).scan.ranges_m[1]));
  EXPECT_EQ(frames.at(1).scan.robot_T_laser.x, 0.5);
}

TEST_F(CarmenReaderTest, keeps_all_readings_of_a_log_that_states_no_maximum_range) {
  const std::string log = "FLASER 4 81.83 79 1 1000 0 0 0 0 0 0 1 host 1\n";
  LogOptions options;
  options.field_of_view_rad = M_PI;
  const auto frames = read(log, options);
  EXPECT_EQ(frames.at(0).scan.max_range_m, 0) << "unknown";
  EXPECT_THAT(frames.at(0).scan.ranges_m, testing::ElementsAre(81.83F, 79, 1, INFINITY));
  EXPECT_EQ(read("PARAM robot_front_laser_max 60 host 1\n" + log, options).at(0).scan.max_range_m, 60);
  options.max_range_m = 70;
  EXPECT_EQ(read(log, options).at(0).scan.max_range_m, 70);
}

TEST_F(CarmenReaderTest, finds_a_laser_that_starts_late) {
  std::string log = "PARAM robot_frontlaser_offset 0.25 host 1\n";
  for (int i = 0; i < 600; ++i) log += odom("0 0 0", std::to_string(i));
  const auto frames = read(log + flaser("FLASER", "0 0 0", "0 0 0", "1"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].scan.robot_T_laser.x, 0.25);
}

TEST_F(CarmenReaderTest, counts_ignored_messages) {
  read("SYNC start\nNMEA-GGA 1 2 3\n" + flaser("FLASER", "1 0 0", "1 0 0", "1") + "NMEA-GGA 4\n" +
       odom("0 0 0", "1") + flaser("FLASER", "1 0 0", "1 0 0", "2"));
  EXPECT_EQ(contents_.laser, "FLASER");
  EXPECT_EQ(contents_.messages.at("NMEA-GGA"), 2U);
  EXPECT_EQ(contents_.messages.at("SYNC"), 1U);
  EXPECT_EQ(contents_.messages.at("ODOM"), 1U);
  EXPECT_EQ(contents_.messages.at("FLASER"), 2U);
  EXPECT_EQ(contents_.scans_with_two_poses, 0U);
}

TEST_F(CarmenReaderTest, odometry_may_be_missing_or_unwanted) {
  EXPECT_FALSE(read(rawlaser("RAWLASER1", "1")).at(0).has_odometry);
  std::string many;
  for (int i = 0; i < 1500; ++i) many += rawlaser("RAWLASER1", "1");
  const auto frames = read(many + odom("0 0 0", "1"));
  ASSERT_EQ(frames.size(), 1500U);
  for (const Frame& frame : frames) EXPECT_FALSE(frame.has_odometry);
  LogOptions none;
  none.odometry = "none";
  EXPECT_FALSE(read(flaser("FLASER", "1 0 0", "1 0 0", "1"), none).at(0).has_odometry);
  EXPECT_FALSE(read(odom("0 0 0", "1") + rawlaser("RAWLASER1", "1"), none).at(0).has_odometry);
}

TEST_F(CarmenReaderTest, reports_missing_scans) {
  EXPECT_THAT(
      sentence_about(odom("0 0 0", "1") + "SYNC\n"),
      testing::AllOf(testing::StartsWith(path_.string() + " has no laser scans, expected lines of one of "),
                     testing::EndsWith("found 1 ODOM, 1 SYNC. Select a laser with log.laser")));
  LogOptions options;
  options.laser = "rear";
  EXPECT_EQ(sentence_about(flaser("FLASER", "0 0 0", "0 0 0", "1"), options),
            path_.string() +
                " has no laser scans, expected lines of one of ROBOTLASER2, RLASER, RAWLASER2; found 1 "
                "FLASER. Select a laser with log.laser");
  EXPECT_THAT(sentence_about("# nothing\n"),
              testing::EndsWith("found no messages. Check that the file is a CARMEN log"));
}

TEST_F(CarmenReaderTest, skips_and_reports_a_malformed_line) {
  const std::string good = flaser("FLASER", "0 0 0", "1 0 0", "1");
  const auto frames = read(good + "\nFLASER 181 1.0 abc\n" + flaser("FLASER", "0 0 0", "2 0 0", "2"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].index, 1U);
  EXPECT_EQ(frames[1].odom_T_robot.x, 2);
  EXPECT_EQ(contents_.skipped.count, 1U);
  EXPECT_EQ(contents_.skipped.first,
            path_.string() + ":3: FLASER: found \"abc\", expected reading 2 of 181 in metres");
  EXPECT_EQ(read("FLASER x\n" + good).size(), 1U) << "the first line of a log may be malformed, too";
}

TEST_F(CarmenReaderTest, skips_malformed_odometry_and_parameters) {
  std::string log = "PARAM robot_front_laser_max 0 host 1\n" + odom("1 0 0", "1") + "ODOM 1.5 2 3\n";
  for (int i = 0; i < 200; ++i) log += rawlaser("RAWLASER1", "1.5");
  const auto frames = read(log + odom("2 0 0", "2"));
  ASSERT_EQ(frames.size(), 200U);
  EXPECT_EQ(frames[0].odom_T_robot.x, 1.5);
  EXPECT_EQ(frames[0].scan.max_range_m, 30);
  EXPECT_EQ(contents_.skipped.count, 2U);
  EXPECT_THAT(contents_.skipped.first, testing::StartsWith(path_.string() + ":1: PARAM: "));
}

TEST_F(CarmenReaderTest, ignores_odom_lines_if_scans_have_odometry) {
  EXPECT_EQ(read(flaser("FLASER", "0 0 0", "0 0 0", "1") + "ODOM 1 2 3\nODOM\n").size(), 1U);
  EXPECT_EQ(contents_.skipped.count, 0U);
}

TEST_F(CarmenReaderTest, a_malformed_early_parameter_fails_no_scan) {
  std::string log =
      "PARAM robot_frontlaser_offset here host 1\nPARAM robot_frontlaser_side_offset 0.2 host 1\n";
  for (int i = 0; i < 600; ++i) log += "SYNC\n";
  const auto frames = read(log + flaser("FLASER", "0 0 0", "0 0 0", "1"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].scan.robot_T_laser.y, 0.2) << "the parameter after the malformed one applies";
  EXPECT_EQ(contents_.skipped.count, 1U);
}

TEST_F(CarmenReaderTest, finds_the_mount_despite_a_malformed_line) {
  const auto frames =
      read(robotlaser("1.2 0 0", "1 0 0", "1") + "ROBOTLASER1 x\n" + robotlaser("2.2 0 0", "2 0 0", "2"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_NEAR(frames[0].scan.robot_T_laser.x, 0.2, 1e-12);
}

TEST_F(CarmenReaderTest, rejects_a_log_with_more_than_one_percent_malformed_lines) {
  const std::string good = flaser("FLASER", "0 0 0", "0 0 0", "1");
  const auto log_of = [&](int good_lines, int bad_lines) {
    std::string log;
    for (int i = 0; i < bad_lines; ++i) log += good + "FLASER 181 1.0\n";
    for (int i = bad_lines; i < good_lines; ++i) log += good;
    return log;
  };
  EXPECT_EQ(read(log_of(297, 3)).size(), 297U);
  EXPECT_EQ(
      sentence_about(log_of(296, 3)),
      path_.string() +
          " is damaged: 3 of its first 299 messages do not parse, expected at most 1 %. Fetch the log again "
          "or repair it. The first one: " +
          path_.string() + ":2: FLASER: the line ends, expected reading 2 of 181 in metres");
  write_file(path_, log_of(150, 150));
  const auto reader = open_carmen_log(path_, {});
  int frames = 0;
  EXPECT_THAT(sentence_of([&] {
                while (reader->next()) ++frames;
              }),
              testing::HasSubstr("101 of its first 202 messages"))
      << "reading stops after 101 malformed lines";
  EXPECT_EQ(frames, 101);
}

TEST_F(CarmenReaderTest, reports_file_and_line_of_a_malformed_message) {
  const std::string good = flaser("FLASER", "0 0 0", "0 0 0", "1");
  EXPECT_EQ(sentence_about("\nFLASER 181 1.0 abc\n"),
            path_.string() + ":2: FLASER: found \"abc\", expected reading 2 of 181 in metres");
  const std::string cut = good + good.substr(0, good.size() / 2);
  EXPECT_THAT(sentence_about(cut),
              testing::StartsWith(path_.string() +
                                  ":2: FLASER: the file is cut off in this line, expected reading "));
}

TEST_F(CarmenReaderTest, yields_the_frames_before_a_truncated_line) {
  write_file(path_, flaser("FLASER", "0 0 0", "1 0 0", "1") + "FLASER 181");
  const auto reader = open_carmen_log(path_, {});
  EXPECT_TRUE(reader->next());
  EXPECT_THROW(reader->next(), UserError);
}

struct KnownLog {
  const char* name;
  std::size_t scans;
  std::size_t beams;
  double seconds;
};

class CarmenReaderOnKnownLogs : public testing::TestWithParam<KnownLog> {};

TEST_P(CarmenReaderOnKnownLogs, reads_every_frame) {
  const KnownLog known = GetParam();
  const auto path = shared_file(std::string(known.name) + ".clf.gz");
  if (!path) GTEST_SKIP() << kNeedsData;
  const auto reader = open_carmen_log(*path, {});
  std::size_t scans = 0;
  TimeUs first_us = 0;
  TimeUs last_us = 0;
  double path_m = 0;
  std::optional<TPose2D> before;
  while (const auto frame = reader->next()) {
    if (scans == 0) first_us = frame->time_us;
    last_us = frame->time_us;
    EXPECT_EQ(frame->index, scans++);
    ASSERT_EQ(frame->scan.ranges_m.size(), known.beams);
    ASSERT_EQ(frame->scan.bearings_rad->size(), known.beams);
    if (before) path_m += (frame->odom_T_robot - *before).norm();
    before = frame->odom_T_robot;
  }
  EXPECT_EQ(scans, known.scans);
  EXPECT_NEAR(seconds(last_us - first_us), known.seconds, 1.0);
  EXPECT_GT(path_m, 100);
}

INSTANTIATE_TEST_SUITE_P(all, CarmenReaderOnKnownLogs,
                         testing::Values(KnownLog{"aces", 7374, 180, 1366},
                                         KnownLog{"intel", 13631, 180, 2691},
                                         KnownLog{"mit-killian", 17480, 180, 7677},
                                         KnownLog{"mit-csail", 1988, 361, 424},
                                         KnownLog{"fr079", 4934, 360, 1061}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace psi_slam
