// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/laser_choice.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;

TEST(LaserChoice, selects_the_usual_one_or_one_by_name_or_several_or_all) {
  EXPECT_FALSE(laser_choice("log.laser", "").several());
  EXPECT_TRUE(laser_choice("log.laser", "").names.empty());
  EXPECT_THAT(laser_choice("log.laser", "Hokuyo UTM").names, ElementsAre("Hokuyo UTM"));
  EXPECT_FALSE(laser_choice("log.laser", "front").several());
  EXPECT_THAT(laser_choice("log.laser", " FLASER , RLASER").names, ElementsAre("FLASER", "RLASER"));
  EXPECT_TRUE(laser_choice("log.laser", "a,b").several());
  EXPECT_TRUE(laser_choice("log.laser", "all").several());
}

TEST(LaserChoice, rejects_empty_and_repeated_names) {
  EXPECT_EQ(sentence_of([] { laser_choice("log.scan_topic", "/a,"); }),
            "log.scan_topic is \"/a,\" with an empty name, expected one laser, \"all\", or several lasers "
            "separated by commas");
  EXPECT_EQ(sentence_of([] { laser_choice("log.laser", "a,b,a"); }),
            "log.laser is \"a,b,a\" with a repeated name, expected one laser, \"all\", or several lasers "
            "separated by commas");
}

TEST(ChosenLasers, have_the_order_of_the_users_list_or_of_the_log) {
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

TEST(StatedMounts, are_parsed_with_name_pose_and_mirroring) {
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

TEST(StatedMounts, reject_malformed_mounts) {
  for (const std::string mount :
       {"FLASER", "FLASER 0.2 0", "0.2 0 0", "FLASER 0.2 0 east", "FLASER 0 0 inf", ","}) {
    LogOptions options;
    options.laser_mounts = mount;
    EXPECT_THAT(sentence_of([&] { stated_mounts(options); }),
                testing::StartsWith("log.laser_mounts contains \""))
        << mount;
  }
}

TEST(StatedMounts, apply_to_any_name_of_the_laser) {
  LogOptions options;
  options.laser_mounts = "rear -0.3 0 180 mirrored";
  EXPECT_EQ(options_of_laser(options, {"RLASER", "rear"}).robot_T_laser->x, -0.3);
  EXPECT_TRUE(options_of_laser(options, {"RLASER", "rear"}).mirrored);
  EXPECT_FALSE(options_of_laser(options, {"FLASER", "front"}).robot_T_laser);
  options.robot_T_laser = TPose2D(1, 2, 3);
  EXPECT_EQ(options_of_laser(options, {"RLASER", "rear"}).robot_T_laser, TPose2D(1, 2, 3));
}

TEST(ChoiceOfLasers, names_combined_lasers_and_those_left_out) {
  EXPECT_EQ(choice_of_lasers({"FRONT"}, {}), "");
  EXPECT_EQ(
      choice_of_lasers({"FRONT", "REAR"}, {"TOP"}),
      "the scans of FRONT, REAR are combined, because their mounts are stated. The scans of TOP are not "
      "used, because no fixed and level mount of their own is stated. State mounts with "
      "log.laser_mounts. Select lasers with log.laser");
}

TEST(LasersOfAFormat, topics_override_lasers_in_bags_only) {
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

TEST(LasersOfAFormat, several_lasers_reject_the_pose_of_a_single_laser) {
  LogOptions options;
  options.scan_topic = "all";
  options.robot_T_laser = TPose2D(1, 2, 3);
  EXPECT_THAT(sentence_of([&] { reads_several_lasers(options, LogFormat::kRos2Mcap); }),
              testing::HasSubstr("with log.laser_mounts"));
  EXPECT_FALSE(reads_several_lasers(options, LogFormat::kCarmen)) << "the topic applies to bags only";
}

}  // namespace
}  // namespace psi_slam
