// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/trajectory_file.h"

#include <gmock/gmock.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <fstream>
#include <random>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;

class TrajectoryFile : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    const auto path = folder_.path() / "trajectory.txt";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  std::string complaint(const std::string& text) const {
    try {
      read_trajectory(file(text));
    } catch (const UserError& error) {
      return error.what();
    }
    return "no complaint";
  }

  TemporaryFolder folder_;
};

TEST_F(TrajectoryFile, tum_has_stamps_of_six_decimals_and_rotations_about_z) {
  EXPECT_EQ(tum_text({{976052905167303, {1.5, -2.25, M_PI}}, {-250000, {0, 0, 0}}}),
            "976052905.167303 1.500000000 -2.250000000 0 0 0 1.000000000000 0.000000000000\n"
            "-0.250000 0.000000000 0.000000000 0 0 0 0.000000000000 1.000000000000\n");
}

TEST_F(TrajectoryFile, reads_the_table_of_a_run) {
  const Trajectory read =
      read_trajectory(file("time_s,x_m,y_m,theta_rad,cov_xx_m2,run\n"
                           "976052905.167303,1.5,-2.25,3.141593,0.01,1\n976052906.000000,2,0,-4,,1\n"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].time_us, 976052905167303);
  EXPECT_EQ(read[0].pose.x, 1.5);
  EXPECT_EQ(read[0].pose.y, -2.25);
  EXPECT_NEAR(std::abs(read[0].pose.phi), M_PI, 1e-6);
  EXPECT_NEAR(read[1].pose.phi, 2 * M_PI - 4, 1e-9);
  EXPECT_THAT(complaint("time_s,x_m,y_m,theta_rad\n1,2,3\n"),
              HasSubstr("trajectory.txt:2: expected values of time_s,x_m,y_m,theta_rad, found 3 values"));
  EXPECT_THAT(complaint("time_s,x_m,y_m,theta_rad\n1,2,,4\n"), HasSubstr("y in metres"));
  EXPECT_THAT(complaint("time_s,x_m,y_m,theta_rad\n"), HasSubstr("no pose found"));
}

TEST_F(TrajectoryFile, tum_reads_back_what_was_written_in_the_same_order) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-1000, 1000);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  Trajectory written;
  for (int i = 0; i < 500; ++i)
    written.push_back({976052905167303 - 1'000 * i, {coordinate(random), coordinate(random), angle(random)}});
  const auto path = folder_.path() / "trajectory.tum";
  write_tum(path, written);
  const Trajectory read = read_trajectory(path);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].time_us, written[i].time_us);
    EXPECT_NEAR(read[i].pose.x, written[i].pose.x, 1e-9);
    EXPECT_NEAR(read[i].pose.y, written[i].pose.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(read[i].pose.phi - written[i].pose.phi), 0, 1e-9);
  }
}

TEST_F(TrajectoryFile, reads_plane_poses_comments_and_foreign_line_ends) {
  const Trajectory read =
      read_trajectory(file("# stamp x y theta\r\n\n 1.5 1 2 0.25 # here\r\n2 -1e0\t+2.5 7\r\n"));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].time_us, 1'500'000);
  EXPECT_EQ(read[0].pose, mrpt::math::TPose2D(1, 2, 0.25));
  EXPECT_EQ(read[1].pose.y, 2.5);
  EXPECT_NEAR(read[1].pose.phi, 7 - 2 * M_PI, 1e-12) << "angles are wrapped to (-pi, pi]";
}

TEST_F(TrajectoryFile, both_signs_of_a_quaternion_are_the_same_rotation) {
  const Trajectory read = read_trajectory(file("1 0 0 0 0 0 0.6 0.8\n2 0 0 0 0 0 -0.6 -0.8\n"));
  EXPECT_NEAR(read[0].pose.phi, 2 * std::atan2(0.6, 0.8), 1e-12);
  EXPECT_NEAR(read[1].pose.phi, read[0].pose.phi, 1e-12);
}

TEST_F(TrajectoryFile, takes_the_first_pose_of_each_flaser_line_of_a_carmen_log) {
  const Trajectory read =
      read_trajectory(file("# CARMEN\nPARAM robot_frontlaser_offset 0.1\nODOM 9 9 9 0 0 0 1.0 host 1.0\n"
                           "FLASER 3 1.0 2.0 81.83 1.5 -2.5 0.5 7 8 9 976052905.167303 host 12.5\n"
                           "FLASER 0 3 4 0 7 8 9 976052904 host 12.6\n"));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].time_us, 976052905167303);
  EXPECT_EQ(read[0].pose, mrpt::math::TPose2D(1.5, -2.5, 0.5));
  EXPECT_EQ(read[1].time_us, 976052904000000) << "poses keep the order of the log";
}

TEST_F(TrajectoryFile, errors_name_file_line_and_what_was_expected) {
  EXPECT_THAT(complaint("1 2 3 4\n1 2 3\n"), HasSubstr("trajectory.txt:2: expected 'timestamp x y theta'"));
  EXPECT_THAT(complaint("1 2 3 4\n1 2 3\n"), HasSubstr("found 3 words"));
  EXPECT_THAT(complaint("1 2 abc 4\n"),
              HasSubstr(":1: expected y in metres, a finite number, as word 3, found 'abc'"));
  EXPECT_THAT(complaint("1 2 nan 4\n"), HasSubstr("found 'nan'"));
  EXPECT_THAT(complaint("1 2 3,5 4\n"), HasSubstr("found '3,5'"));
  EXPECT_THAT(complaint("yesterday 2 3 4\n"), HasSubstr("expected a time stamp in seconds as word 1"));
  EXPECT_THAT(complaint("1 2 3 0 0 0 0 0\n"), HasSubstr("quaternion with qz = qw = 0"));
  EXPECT_THAT(complaint("FLASER 3 1.0 2.0 1.5 -2.5 0.5 7 8 9 12.0 host 12.5\n"),
              HasSubstr("does not match n"));
  EXPECT_THAT(complaint("FLASER\n"), HasSubstr("does not match n"));
  EXPECT_THAT(complaint("# nothing\n"), HasSubstr("no pose found"));
  EXPECT_THAT(complaint("PARAM a b\n"), HasSubstr("no pose found"));
  EXPECT_THAT(complaint("\x1f\x8b\x08\x01\n"), HasSubstr("expected")) << "binary words are not printed";
  EXPECT_THROW(read_trajectory(folder_.path() / "missing.tum"), UserError);
  EXPECT_THROW(read_trajectory(folder_.path()), UserError) << "the path is a folder";
}

}  // namespace
}  // namespace psi_slam
