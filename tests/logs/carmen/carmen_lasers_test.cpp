// SPDX-License-Identifier: BSD-3-Clause
#include "logs/carmen/carmen_lasers.h"

#include <gmock/gmock.h>
#include <mrpt/core/bits_math.h>

#include <cmath>
#include <cstdio>

#include "log_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

class CarmenLaserTest : public testing::Test {
 protected:
  void SetUp() override {
    write_file(path_, "FLASER\n");
    lines_ = std::make_unique<LineReader>(path_);
    std::string_view line;
    lines_->next(line);
  }

  LaserScan scan(CarmenLaser& laser, std::size_t beams, CarmenLaserMessage message = {}) {
    message.ranges_m.assign(beams, 1.0F);
    return laser.scan(message, CarmenFields("FLASER", *lines_));
  }

  void give_parameter(CarmenLaser& laser, const std::string& name_and_value) {
    const std::string line = "PARAM " + name_and_value;
    CarmenFields fields(line, *lines_);
    laser.take_parameter(fields);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
  std::unique_ptr<LineReader> lines_;
};

TEST_F(CarmenLaserTest, shares_bearings_between_scans_of_one_shape) {
  CarmenLaser laser("FLASER", {});
  const auto first = scan(laser, 180);
  const auto second = scan(laser, 180);
  const auto other = scan(laser, 361);
  EXPECT_EQ(first.bearings_rad.get(), second.bearings_rad.get());
  ASSERT_EQ(other.bearings_rad->size(), 361U);
  EXPECT_NEAR(other.bearings_rad->back(), M_PI / 2, 1e-6);
  EXPECT_EQ(first.bearings_rad->size(), 180U) << "the earlier bearings are unchanged";
}

TEST_F(CarmenLaserTest, uses_the_angles_of_the_message) {
  CarmenLaser laser("RAWLASER1", {});
  CarmenLaserMessage message;
  message.start_angle_rad = -1;
  message.resolution_rad = 0.25;
  message.field_of_view_rad = 2.5;  // the resolution takes precedence
  EXPECT_THAT(*scan(laser, 3, message).bearings_rad, testing::ElementsAre(-1.0F, -0.75F, -0.5F));
  message.resolution_rad = 0;
  EXPECT_THAT(*scan(laser, 3, message).bearings_rad, testing::ElementsAre(-1.0F, 0.25F, 1.5F));
}

TEST_F(CarmenLaserTest, options_override_angles_and_direction) {
  LogOptions options;
  options.beam_angles = BeamAngles::kCentredStepInclusive;
  options.field_of_view_rad = 2.0;
  options.mirrored = true;
  CarmenLaser laser("RAWLASER1", options);
  CarmenLaserMessage message;
  message.resolution_rad = 0.25;
  EXPECT_THAT(*scan(laser, 3, message).bearings_rad, testing::ElementsAre(1.0F, 0.0F, -1.0F));
}

TEST_F(CarmenLaserTest, requires_a_field_of_view_for_unusual_numbers_of_beams) {
  CarmenLaser laser("FLASER", {});
  EXPECT_EQ(sentence_of([&] { scan(laser, 97); }),
            path_.string() +
                ":1: FLASER: a scan of 97 readings states no angles and has no usual field of view. State it "
                "with log.field_of_view_deg");
  give_parameter(laser, "laser_front_laser_resolution 1.5");
  const auto bearings = scan(laser, 97).bearings_rad;
  EXPECT_NEAR(bearings->at(1) - bearings->at(0), DEG2RAD(1.5), 1e-6);
  EXPECT_NEAR(bearings->at(48), 0, 1e-6);
}

TEST_F(CarmenLaserTest, mount_comes_from_user_then_parameter_then_poses) {
  LogOptions options;
  CarmenLaser laser("ROBOTLASER1", options);
  EXPECT_EQ(scan(laser, 180).robot_T_laser, (TPose2D{0, 0, 0}));
  laser.set_mount_by_poses({0.1, 0, 0});
  EXPECT_EQ(scan(laser, 180).robot_T_laser, (TPose2D{0.1, 0, 0}));
  give_parameter(laser, "robot_frontlaser_offset 0.2 host 1");
  give_parameter(laser, "robot_rearlaser_offset 9 host 1");
  EXPECT_EQ(scan(laser, 180).robot_T_laser, (TPose2D{0.2, 0, 0}));
  give_parameter(laser, "robot_frontlaser_side_offset -0.05");
  give_parameter(laser, "robot_frontlaser_angular_offset 0.5");
  EXPECT_EQ(scan(laser, 180).robot_T_laser, (TPose2D{0.2, -0.05, 0.5}));

  options.robot_T_laser = TPose2D{1, 2, 3};
  CarmenLaser stated("FLASER", options);
  give_parameter(stated, "robot_frontlaser_offset 0.2");
  EXPECT_EQ(scan(stated, 180).robot_T_laser, (TPose2D{1, 2, 3}));
}

TEST_F(CarmenLaserTest, rear_laser_looks_backwards) {
  CarmenLaser laser("RLASER", {});
  give_parameter(laser, "robot_rearlaser_offset -0.3");
  const auto mount = scan(laser, 180).robot_T_laser;
  EXPECT_EQ(mount.x, -0.3);
  EXPECT_NEAR(std::abs(mount.phi), M_PI, 1e-12);
}

TEST_F(CarmenLaserTest, maximum_range_comes_from_user_then_message_then_parameter) {
  CarmenLaser laser("FLASER", {});
  EXPECT_EQ(scan(laser, 180).max_range_m, 0) << "unknown";
  give_parameter(laser, "robot_front_laser_max 20");
  EXPECT_EQ(scan(laser, 180).max_range_m, 20.0F);
  CarmenLaserMessage message;
  message.max_range_m = 10;
  EXPECT_EQ(scan(laser, 180, message).max_range_m, 10.0F);
  LogOptions options;
  options.max_range_m = 0.5;
  CarmenLaser stated("FLASER", options);
  const auto limited = scan(stated, 180, message);
  EXPECT_EQ(limited.max_range_m, 0.5F);
  EXPECT_TRUE(std::isinf(limited.ranges_m[0])) << "1 m is beyond the maximum range";
}

TEST_F(CarmenLaserTest, rejects_invalid_parameters) {
  CarmenLaser laser("FLASER", {});
  EXPECT_EQ(sentence_of([&] { give_parameter(laser, "robot_front_laser_max 0"); }),
            path_.string() + ":1: PARAM: the laser's maximum range is not positive, expected metres");
  EXPECT_THROW(give_parameter(laser, "laser_front_laser_resolution -1"), UserError);
  EXPECT_THROW(give_parameter(laser, "robot_frontlaser_offset here"), UserError);
  EXPECT_NO_THROW(give_parameter(laser, "robot_name some text"));
  EXPECT_EQ(scan(laser, 180).max_range_m, 0) << "invalid values change nothing";
}

TEST_F(CarmenLaserTest, lists_the_messages_of_each_laser) {
  EXPECT_THAT(carmen_laser_messages("front"), testing::ElementsAre("ROBOTLASER1", "FLASER", "RAWLASER1"));
  EXPECT_THAT(carmen_laser_messages("rear"), testing::ElementsAre("ROBOTLASER2", "RLASER", "RAWLASER2"));
  EXPECT_THAT(carmen_laser_messages("RAWLASER4"), testing::ElementsAre("RAWLASER4"));
  EXPECT_EQ(carmen_laser_messages("").size(), 8U);
  EXPECT_EQ(carmen_laser_messages("").front(), "ROBOTLASER1");
  EXPECT_EQ(
      sentence_of([] { carmen_laser_messages("left"); }),
      "log.laser is \"left\", expected \"front\", \"rear\" or the name of a CARMEN laser message such as "
      "\"RAWLASER1\"");
}

std::string robotlaser(const TPose2D& laser, const TPose2D& robot) {
  char text[300];
  std::snprintf(
      text, sizeof text,
      "ROBOTLASER1 0 -1.57 3.14 0.1 50 0 0 1 2.0 0 %.6f %.6f %.6f %.6f %.6f %.6f 0 0 0 0 0 1.0 host 1\n",
      laser.x, laser.y, laser.phi, robot.x, robot.y, robot.phi);
  return text;
}

/// Log of a robot that drives along a curve. With each step, the laser's pose departs from odometry by a
/// further `drift`.
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

TEST_F(CarmenMountTest, is_unknown_if_the_laser_pose_was_corrected) {
  EXPECT_FALSE(mount_in(log_with_drift({0.3, 0, 0}, {0.002, 0, 0})));
  EXPECT_FALSE(mount_in(log_with_drift({0.3, 0, 0}, {0, 0, 0.001})));
}

TEST_F(CarmenMountTest, skips_malformed_lines) {
  EXPECT_TRUE(mount_in("ROBOTLASER1 garbled\n" + log_with_drift({0.3, -0.1, 0.2}, {})));
}

TEST_F(CarmenMountTest, is_unknown_without_such_lines) {
  EXPECT_FALSE(mount_in("FLASER 1 1.0 0 0 0 0 0 0 1.0 host 1\n"));
}

}  // namespace
}  // namespace psi_slam
