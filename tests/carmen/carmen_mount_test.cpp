// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_mount.h"

#include <cmath>
#include <cstdio>

#include "log_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::string robotlaser(const TPose2D& laser, const TPose2D& robot) {
  char text[300];
  std::snprintf(
      text, sizeof text,
      "ROBOTLASER1 0 -1.57 3.14 0.1 50 0 0 1 2.0 0 %.6f %.6f %.6f %.6f %.6f %.6f 0 0 0 0 0 1.0 host 1\n",
      laser.x, laser.y, laser.phi, robot.x, robot.y, robot.phi);
  return text;
}

/// A robot on a curve; `drift` is how far the laser's pose gets away from the odometry at each step.
std::string log_with_drift(const TPose2D& robot_T_laser, const TPose2D& drift) {
  std::string text = "# comment\n";
  TPose2D robot{10, 20, 2};
  TPose2D corrected = robot;
  for (int i = 0; i < 40; ++i) {
    text += robotlaser(corrected + robot_T_laser, robot);
    robot = robot + TPose2D{0.2, 0, 0.05};
    corrected = corrected + TPose2D{0.2, 0, 0.05} + drift;
  }
  return text;
}

class CarmenMountTest : public testing::Test {
 protected:
  std::optional<TPose2D> mount_in(const std::string& log) {
    write_file(path_, log);
    return mount_by_robotlaser(path_, "ROBOTLASER1");
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
};

TEST_F(CarmenMountTest, is_the_constant_difference_of_the_poses) {
  const auto mount = mount_in(log_with_drift({0.3, -0.1, 0.2}, {}));
  ASSERT_TRUE(mount);
  EXPECT_NEAR(mount->x, 0.3, 1e-5);
  EXPECT_NEAR(mount->y, -0.1, 1e-5);
  EXPECT_NEAR(mount->phi, 0.2, 1e-5);
}

TEST_F(CarmenMountTest, is_unknown_when_the_laser_pose_was_corrected) {
  EXPECT_FALSE(mount_in(log_with_drift({0.3, 0, 0}, {0.002, 0, 0})));
  EXPECT_FALSE(mount_in(log_with_drift({0.3, 0, 0}, {0, 0, 0.001})));
}

TEST_F(CarmenMountTest, passes_over_lines_that_do_not_parse) {
  EXPECT_TRUE(mount_in("ROBOTLASER1 garbled\n" + log_with_drift({0.3, -0.1, 0.2}, {})));
}

TEST_F(CarmenMountTest, is_unknown_without_such_lines) {
  EXPECT_FALSE(mount_in("FLASER 1 1.0 0 0 0 0 0 0 1.0 host 1\n"));
}

}  // namespace
}  // namespace psi_slam
