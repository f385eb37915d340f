// SPDX-License-Identifier: BSD-3-Clause
#include "logs/carmen/carmen_message.h"

#include <gmock/gmock.h>

#include <cmath>

#include "log_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;

class CarmenFieldsTest : public testing::Test {
 protected:
  /// Writes a file with the line `text` and calls `take` with the fields of this line.
  template <class Take>
  void with_line(const std::string& text, Take take) {
    write_file(path_, text);
    LineReader lines(path_);
    std::string_view line;
    ASSERT_TRUE(lines.next(line));
    CarmenFields fields(line, lines);
    take(fields);
  }

  template <class Take>
  std::string sentence_about(const std::string& text, Take take) {
    return sentence_of([&] { with_line(text, take); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
  std::string place_ = path_.string() + ":1: ";
};

TEST_F(CarmenFieldsTest, parses_fields_between_blanks_and_tabs) {
  with_line("ODOM  1.5\t+2 -3e-1 7  word 976052905.167303 \n", [](CarmenFields& fields) {
    EXPECT_EQ(fields.message(), "ODOM");
    EXPECT_EQ(fields.number("x"), 1.5);
    EXPECT_EQ(fields.number("y"), 2);
    EXPECT_EQ(fields.number("z"), -0.3);
    EXPECT_EQ(fields.count("n"), 7U);
    EXPECT_EQ(fields.word("w"), "word");
    EXPECT_EQ(fields.time("t"), 976052905167303);
  });
}

TEST_F(CarmenFieldsTest, wraps_headings) {
  with_line("A 1 2 7\n", [](CarmenFields& fields) {
    const auto pose = fields.pose("the pose");
    EXPECT_EQ(pose.x, 1);
    EXPECT_EQ(pose.y, 2);
    EXPECT_NEAR(pose.phi, 7 - 2 * M_PI, 1e-12);
  });
}

TEST_F(CarmenFieldsTest, parses_nan_and_infinite_ranges) {
  with_line("A 1.25 -1 nan inf 1e99 0\n", [](CarmenFields& fields) {
    const auto ranges_m = fields.ranges(6);
    EXPECT_EQ(ranges_m[0], 1.25F);
    EXPECT_EQ(ranges_m[1], -1.0F);
    EXPECT_TRUE(std::isnan(ranges_m[2]));
    EXPECT_TRUE(std::isinf(ranges_m[3]));
    EXPECT_TRUE(std::isinf(ranges_m[4]));
    EXPECT_EQ(ranges_m[5], 0.0F);
  });
}

TEST_F(CarmenFieldsTest, reports_what_was_found_and_expected) {
  EXPECT_EQ(sentence_about("ODOM 1,5\n", [](auto& fields) { fields.number("tv"); }),
            place_ + "ODOM: found \"1,5\", expected tv, a number");
  EXPECT_EQ(sentence_about("ODOM nan\n", [](auto& fields) { fields.number("tv"); }),
            place_ + "ODOM: found \"nan\", expected tv, a number");
  EXPECT_EQ(sentence_about("ODOM -3\n", [](auto& fields) { fields.count("the number of readings"); }),
            place_ + "ODOM: found \"-3\", expected the number of readings, a whole number up to 100000");
  EXPECT_EQ(sentence_about("ODOM 1.0.0\n", [](auto& fields) { fields.time("ipc_timestamp"); }),
            place_ + "ODOM: found \"1.0.0\", expected ipc_timestamp in seconds");
  EXPECT_EQ(sentence_about("A 1 2x 3\n", [](auto& fields) { fields.ranges(3); }),
            place_ + "A: found \"2x\", expected reading 2 of 3 in metres");
  EXPECT_EQ(sentence_about("A 1 2 x\n", [](auto& fields) { fields.pose("the pose"); }),
            place_ + "A: found \"x\", expected theta of the pose, a number");
  EXPECT_EQ(sentence_about(std::string("ODOM 1\0x\n", 9), [](auto& fields) { fields.number("tv"); }),
            place_ + "ODOM: found \"1?x\", expected tv, a number");
  EXPECT_EQ(sentence_about("A 1 x\n", [](auto& fields) { fields.skip_numbers(2, "remission"); }),
            place_ + "A: found \"x\", expected remission 2 of 2");
}

TEST_F(CarmenFieldsTest, distinguishes_a_short_line_from_a_truncated_file) {
  EXPECT_EQ(sentence_about("A 1 2\n", [](auto& fields) { fields.ranges(3); }),
            place_ + "A: the line ends, expected reading 3 of 3 in metres");
  EXPECT_EQ(sentence_about("A 1 2", [](auto& fields) { fields.ranges(3); }),
            place_ + "A: the file is cut off in this line, expected reading 3 of 3 in metres");
}

TEST_F(CarmenFieldsTest, expects_three_fields_at_the_end_of_a_line) {
  with_line("A 12.5 approx 3\n", [](auto& fields) { EXPECT_EQ(fields.stamps(), 12'500'000); });
  EXPECT_EQ(sentence_about("A 12.5\n", [](auto& fields) { fields.stamps(); }),
            place_ + "A: the line ends, expected the host's name after ipc_timestamp");
  EXPECT_EQ(sentence_about("A 12.5 host", [](auto& fields) { fields.stamps(); }),
            place_ + "A: the file is cut off in this line, expected logger_timestamp in seconds");
}

class CarmenMessageTest : public testing::Test {
 protected:
  template <class Message>
  Message read(Message (*reader)(CarmenFields&), const std::string& line_text) {
    write_file(path_, line_text + "\n");
    LineReader lines(path_);
    std::string_view line;
    lines.next(line);
    CarmenFields fields(line, lines);
    return reader(fields);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
};

TEST_F(CarmenMessageTest, flaser_has_ranges_two_poses_and_the_time) {
  const auto message = read(read_flaser, "FLASER 3 1.5 2.5 81.83 1 2 3 4 5 -3 976052905.167303 approx 7.5");
  EXPECT_EQ(message.time_us, 976052905167303);
  EXPECT_THAT(message.ranges_m, ElementsAre(1.5F, 2.5F, 81.83F));
  EXPECT_EQ(message.odom_T_laser, (TPose2D{1, 2, 3}));
  EXPECT_EQ(message.odom_T_robot, (TPose2D{4, 5, -3}));
  EXPECT_EQ(message.field_of_view_rad, 0);
  EXPECT_EQ(message.max_range_m, 0);
}

TEST_F(CarmenMessageTest, rawlaser_has_its_angles_and_no_pose) {
  const auto message =
      read(read_rawlaser, "RAWLASER1 0 -1.5 3.1 0.01 50 0.02 1  2 1.5 2.5  3 7 8 9  12.000001 host 0.1");
  EXPECT_EQ(message.time_us, 12'000'001);
  EXPECT_THAT(message.ranges_m, ElementsAre(1.5F, 2.5F));
  EXPECT_EQ(message.start_angle_rad, -1.5);
  EXPECT_EQ(message.field_of_view_rad, 3.1);
  EXPECT_EQ(message.resolution_rad, 0.01);
  EXPECT_EQ(message.max_range_m, 50);
}

TEST_F(CarmenMessageTest, robotlaser_has_its_angles_and_both_poses) {
  const auto message =
      read(read_robotlaser,
           "ROBOTLASER1 0 -1.5 3.1 0.01 50 0.02 0  2 1.5 2.5  0  1.1 2 3  1 2 3  0.5 0.6 1 1 0"
           "  12.5 host 0.1");
  EXPECT_EQ(message.time_us, 12'500'000);
  EXPECT_EQ(message.odom_T_laser, (TPose2D{1.1, 2, 3}));
  EXPECT_EQ(message.odom_T_robot, (TPose2D{1, 2, 3}));
  EXPECT_EQ(message.max_range_m, 50);
}

TEST_F(CarmenMessageTest, odometry_has_a_pose_and_the_time) {
  const auto message = read(read_odometry, "ODOM 1 2 -1 0.1 0.2 0 5.25 host 1");
  EXPECT_EQ(message.time_us, 5'250'000);
  EXPECT_EQ(message.odom_T_robot, (TPose2D{1, 2, -1}));
}

TEST_F(CarmenMessageTest, a_scan_without_readings_is_malformed) {
  EXPECT_EQ(sentence_of([&] { read(read_flaser, "FLASER 0 1 2 3 4 5 6 7 host 8"); }),
            path_.string() + ":1: FLASER: the scan has 0 readings, expected 1 or more");
}

TEST_F(CarmenMessageTest, a_wrong_number_of_readings_is_malformed) {
  EXPECT_EQ(
      sentence_of([&] { read(read_flaser, "FLASER 4 1.5 2.5 81.83 1 2 3 4 5 -3 976052905.167303 host 7"); }),
      path_.string() + ":1: FLASER: found \"host\", expected ipc_timestamp in seconds");
  EXPECT_EQ(sentence_of([&] { read(read_robotlaser, "ROBOTLASER1 0 -1.5 3.1 0.01 50 0.02 0 2 1.5"); }),
            path_.string() + ":1: ROBOTLASER1: the line ends, expected reading 2 of 2 in metres");
}

}  // namespace
}  // namespace psi_slam
