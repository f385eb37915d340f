// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_message.h"

#include <gmock/gmock.h>

#include "log_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;

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

TEST_F(CarmenMessageTest, a_wrong_count_is_found_out) {
  EXPECT_EQ(
      sentence_of([&] { read(read_flaser, "FLASER 4 1.5 2.5 81.83 1 2 3 4 5 -3 976052905.167303 host 7"); }),
      path_.string() + ":1: FLASER: found \"host\", expected ipc_timestamp in seconds");
  EXPECT_EQ(sentence_of([&] { read(read_robotlaser, "ROBOTLASER1 0 -1.5 3.1 0.01 50 0.02 0 2 1.5"); }),
            path_.string() + ":1: ROBOTLASER1: the line ends, expected reading 2 of 2 in metres");
}

}  // namespace
}  // namespace psi_slam
