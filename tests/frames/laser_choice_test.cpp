// SPDX-License-Identifier: BSD-3-Clause
#include "frames/laser_choice.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;

TEST(LaserChoice, is_the_usual_one_or_one_or_several_or_all) {
  EXPECT_FALSE(laser_choice("log.laser", "").several());
  EXPECT_TRUE(laser_choice("log.laser", "").names.empty());
  EXPECT_THAT(laser_choice("log.laser", "Hokuyo UTM").names, ElementsAre("Hokuyo UTM"));
  EXPECT_FALSE(laser_choice("log.laser", "front").several());
  EXPECT_THAT(laser_choice("log.laser", " FLASER , RLASER").names, ElementsAre("FLASER", "RLASER"));
  EXPECT_TRUE(laser_choice("log.laser", "a,b").several());
  EXPECT_TRUE(laser_choice("log.laser", "all").several());
}

TEST(LaserChoice, refuses_names_that_are_missing_or_come_twice) {
  EXPECT_EQ(
      sentence_of([] { laser_choice("log.scan_topic", "/a,"); }),
      "log.scan_topic = \"/a,\" has a name missing, expected one laser, \"all\", or several with a comma "
      "between any two");
  EXPECT_EQ(
      sentence_of([] { laser_choice("log.laser", "a,b,a"); }),
      "log.laser = \"a,b,a\" has a name twice, expected one laser, \"all\", or several with a comma between "
      "any two");
}

TEST(ChosenLasers, number_by_the_users_order_or_by_the_logs) {
  ChosenLasers listed(laser_choice("", "b,a"));
  EXPECT_EQ(listed.number_of("a"), 1U);
  EXPECT_EQ(listed.number_of("c"), std::nullopt);
  EXPECT_EQ(listed.number_of("b"), 0U);
  ChosenLasers all(laser_choice("", "all"));
  EXPECT_EQ(all.number_of("c"), 0U);
  EXPECT_EQ(all.number_of("a"), 1U);
  EXPECT_EQ(all.number_of("c"), 0U);
  EXPECT_THAT(all.names(), ElementsAre("c", "a"));
  ChosenLasers first(laser_choice("", ""));
  EXPECT_EQ(first.number_of("c"), 0U);
  EXPECT_EQ(first.number_of("a"), std::nullopt);
}

TEST(StatedMounts, hold_a_pose_in_metres_and_degrees_and_whether_it_is_upside_down) {
  LogOptions options;
  EXPECT_TRUE(stated_mounts(options).empty());
  options.laser_mounts = "FLASER 0.2 0 0,  Hokuyo UTM -0.3 0.1 270 mirrored ";
  const auto mounts = stated_mounts(options);
  ASSERT_EQ(mounts.size(), 2U);
  EXPECT_EQ(mounts[0].robot_T_laser, TPose2D(0.2, 0, 0));
  EXPECT_FALSE(mounts[0].mirrored);
  EXPECT_EQ(mounts[1].name, "Hokuyo UTM");
  EXPECT_NEAR(mounts[1].robot_T_laser.phi, -M_PI / 2, 1e-12);
  EXPECT_TRUE(mounts[1].mirrored);
}

TEST(StatedMounts, refuse_what_is_no_mount) {
  for (const std::string mount :
       {"FLASER", "FLASER 0.2 0", "0.2 0 0", "FLASER 0.2 0 east", "FLASER 0 0 inf", ","}) {
    LogOptions options;
    options.laser_mounts = mount;
    EXPECT_THAT(sentence_of([&] { stated_mounts(options); }), testing::StartsWith("log.laser_mounts has \""))
        << mount;
  }
}

TEST(StatedMounts, hold_for_the_laser_of_any_of_its_names) {
  LogOptions options;
  options.laser_mounts = "rear -0.3 0 180 mirrored";
  EXPECT_EQ(options_of_laser(options, {"RLASER", "rear"}).robot_T_laser->x, -0.3);
  EXPECT_TRUE(options_of_laser(options, {"RLASER", "rear"}).mirrored);
  EXPECT_FALSE(options_of_laser(options, {"FLASER", "front"}).robot_T_laser);
  options.robot_T_laser = TPose2D(1, 2, 3);
  EXPECT_EQ(options_of_laser(options, {"RLASER", "rear"}).robot_T_laser, TPose2D(1, 2, 3));
}

TEST(LasersOfAFormat, topics_count_for_bags_alone_and_stand_over_the_lasers) {
  LogOptions options;
  for (const LogFormat format : {LogFormat::kCarmen, LogFormat::kMrptRawlog, LogFormat::kRos1Bag}) {
    SCOPED_TRACE(name_of(format));
    options.laser = "all";
    options.scan_topic.clear();
    EXPECT_TRUE(reads_several_lasers(options, format));
    options.scan_topic = "/scan";
    EXPECT_EQ(reads_several_lasers(options, format), !is_bag(format));
    options.laser = "front";
    EXPECT_FALSE(reads_several_lasers(options, format));
    options.scan_topic = "/front,/rear";
    EXPECT_EQ(reads_several_lasers(options, format), is_bag(format));
  }
}

TEST(LasersOfAFormat, several_have_no_pose_for_one) {
  LogOptions options;
  options.scan_topic = "all";
  options.robot_T_laser = TPose2D(1, 2, 3);
  EXPECT_THAT(sentence_of([&] { reads_several_lasers(options, LogFormat::kRos2Mcap); }),
              testing::HasSubstr("expected log.laser_mounts"));
  EXPECT_FALSE(reads_several_lasers(options, LogFormat::kCarmen)) << "it has one laser, the topic is a bag's";
}

}  // namespace
}  // namespace psi_slam
