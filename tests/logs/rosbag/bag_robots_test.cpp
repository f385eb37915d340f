// SPDX-License-Identifier: BSD-3-Clause
// Bags that recorded several robots, and bags with several topics of one laser.
#include <gmock/gmock.h>

#include <functional>
#include <random>
#include <string>

#include "bag_files.h"
#include "log_files.h"
#include "simulated_room.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose3D;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Path = std::filesystem::path;

/// Names of the topics and frames of one robot.
struct RobotNames {
  std::string topics;  // precedes the names of its topics, such as "/robot1"
  std::string frames;  // precedes the names of its frames, such as "robot1/"
  std::string tf = "/tf";
  std::string tf_static = "/tf_static";
};

struct TwoRobots {
  std::string name;
  RobotNames first;
  RobotNames second;
  bool has_mounts = true;           // whether there are transforms
  bool has_odometry_topics = true;  // otherwise odometry is a transform
  bool has_map = false;             // whether a common map frame connects the robots
  friend void PrintTo(const TwoRobots& robots, std::ostream* out) { *out << robots.name; }
};

constexpr double kApart_m = 100;

/// Adds the messages of a robot whose y is `y_m` and whose laser is `laser_x_m` ahead.
void record(Recording& recording, const TwoRobots& robots, const RobotNames& names, double y_m,
            double laser_x_m) {
  if (robots.has_mounts)
    recording.insert(recording.begin(), RecordedPose{names.tf_static,
                                                     1'000'000,
                                                     names.frames + "base_link",
                                                     names.frames + "laser",
                                                     {laser_x_m, 0, 0.2, 0, 0, 0}});
  if (robots.has_map)
    recording.insert(recording.begin(),
                     RecordedPose{names.tf_static, 1'000'000, "map", names.frames + "odom", TPose3D()});
  for (int i = 0; i < 30; ++i) {
    const TimeUs time_us = 1'600'000'000'000'000 + i * 100'000;
    const TPose3D pose{0.1 * i, y_m, 0, 0, 0, 0};
    if (robots.has_odometry_topics)
      recording.emplace_back(RecordedPose{names.topics + "/odom", time_us, names.frames + "odom",
                                          names.frames + "base_link", pose});
    if (robots.has_mounts)
      recording.emplace_back(
          RecordedPose{names.tf, time_us, names.frames + "odom", names.frames + "base_link", pose});
    RecordedScan scan;
    scan.topic = names.topics + "/scan";
    scan.time_us = time_us;
    scan.frame = names.frames + "laser";
    recording.emplace_back(scan);
  }
}

class BagOfRobots : public testing::TestWithParam<TwoRobots> {
 protected:
  void SetUp() override {
    Recording recording;
    record(recording, GetParam(), GetParam().first, 0, 0.1);
    record(recording, GetParam(), GetParam().second, kApart_m, 0.3);
    std::stable_sort(recording.begin(), recording.end(),
                     [](const Recorded& a, const Recorded& b) { return time_of(a) < time_of(b); });
    write_mcap(path_, recording);
  }

  void expect_robot(const std::vector<Frame>& frames, double y_m, double laser_x_m) const {
    ASSERT_EQ(frames.size(), 30U);
    for (const Frame& frame : frames) {
      EXPECT_TRUE(frame.companions.empty());
      ASSERT_TRUE(frame.has_odometry);
      EXPECT_NEAR(frame.odom_T_robot.y, y_m, 1e-9);
      EXPECT_NEAR(frame.scan.robot_T_laser.x, GetParam().has_mounts ? laser_x_m : 0, 1e-9);
    }
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.mcap";
};

TEST_P(BagOfRobots, gives_each_laser_the_odometry_and_mount_of_its_robot) {
  for (const bool first : {true, false}) {
    LogOptions options;
    options.scan_topic = (first ? GetParam().first : GetParam().second).topics + "/scan";
    const auto log = open_log(path_, options);
    expect_robot(all_frames(*log), first ? 0 : kApart_m, first ? 0.1 : 0.3);
    EXPECT_THAT(log->assumptions(), Not(Contains(HasSubstr("odometry"))));
  }
}

TEST_P(BagOfRobots, maps_the_first_robot_and_lists_all) {
  const auto log = open_log(path_);
  expect_robot(all_frames(*log), 0, 0.1);
  EXPECT_THAT(log->assumptions(), Contains(AllOf(HasSubstr("the bag recorded 2 robots"),
                                                 HasSubstr(GetParam().second.topics + "/scan"))));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BagOfRobots,
    testing::Values(
        TwoRobots{"prefixed_frames", {"/robot1", "robot1/"}, {"/robot2", "robot2/"}},
        TwoRobots{"equal_frames_and_own_transforms",
                  {"/robot1", "", "/robot1/tf", "/robot1/tf_static"},
                  {"/robot2", "", "/robot2/tf", "/robot2/tf_static"}},
        TwoRobots{"without_transforms", {"/red", ""}, {"/blue", ""}, false},
        TwoRobots{"one_without_a_namespace", {"", ""}, {"/robot2", "", "/robot2/tf", "/robot2/tf_static"}},
        TwoRobots{"odometry_as_transforms", {"/a", "a/"}, {"/b", "b/"}, true, false},
        TwoRobots{"connected_by_a_map", {"/a", "a_"}, {"/b", "b_"}, true, true, true},
        TwoRobots{"transforms_connected_by_a_map", {"/a", "a_"}, {"/b", "b_"}, true, false, true}),
    [](const auto& tested) { return tested.param.name; });

TEST(BagWithScansOfNoRobot, maps_a_robot_and_lists_no_other) {
  for (const char* topic : {"/merged_scan", "/ceiling/scan"}) {
    const TemporaryFolder folder;
    const TwoRobots robots{"", {"/robot1", "robot1/"}, {"/robot2", "robot2/"}};
    Recording recording;
    record(recording, robots, robots.first, 0, 0.1);
    record(recording, robots, robots.second, kApart_m, 0.3);
    RecordedScan merged = std::get<RecordedScan>(recording.back());
    merged.topic = topic;
    merged.frame = "world";
    recording.insert(recording.begin(), merged);
    write_mcap(folder.path() / "bag", recording);
    const auto log = open_log(folder.path() / "bag");
    const auto frames = all_frames(*log);
    ASSERT_EQ(frames.size(), 30U);
    EXPECT_TRUE(frames[3].has_odometry);
    EXPECT_NEAR(frames[3].odom_T_robot.y, 0, 1e-9);
    EXPECT_THAT(log->assumptions(),
                testing::ElementsAre("the bag recorded 2 robots: /robot1 (/robot1/scan), /robot2 "
                                     "(/robot2/scan). /robot1 is mapped; select the scans of another one "
                                     "with log.scan_topic",
                                     std::string("the scans of ") + topic +
                                         " are not used, because the mount of their laser on the robot is "
                                         "unknown. Select topics with log.scan_topic"));
  }
}

TEST(BagOfOneRobot, with_namespaces_of_devices_is_one_robot) {
  const TemporaryFolder folder;
  Recording recording;
  for (Recorded message : recorded_run()) {
    if (auto* scan = std::get_if<RecordedScan>(&message)) scan->topic = "/front/scan";
    if (auto* pose = std::get_if<RecordedPose>(&message); pose != nullptr && !pose->is_transform())
      pose->topic = "/velocity_controller/odom";
    recording.push_back(message);
  }
  write_mcap(folder.path() / "bag", recording);
  const auto log = open_log(folder.path() / "bag");
  const auto frames = all_frames(*log);
  ASSERT_EQ(frames.size(), 20U);
  EXPECT_TRUE(frames[5].has_odometry);
  EXPECT_TRUE(log->assumptions().empty());
}

TEST(BagOfOneRobot, never_has_the_odometry_of_another_robot) {
  const TemporaryFolder folder;
  const TwoRobots robots{"", {"/a", ""}, {"/b", "", "/b/tf", "/b/tf_static"}, false};
  Recording recording;
  record(recording, robots, robots.first, 0, 0.1);
  for (const Recorded& message : recorded_run()) {
    if (const auto* scan = std::get_if<RecordedScan>(&message)) {
      recording.emplace_back(*scan).emplace<RecordedScan>(*scan).topic = "/b/scan";
    }
  }
  RecordedPose mount = static_mount();
  mount.topic = "/b/tf_static";
  recording.insert(recording.begin(), mount);
  write_mcap(folder.path() / "bag", recording);
  LogOptions options;
  options.scan_topic = "/b/scan";
  const auto log = open_log(folder.path() / "bag", options);
  const auto frames = all_frames(*log);
  ASSERT_EQ(frames.size(), 20U);
  EXPECT_FALSE(frames[3].has_odometry);
  EXPECT_THAT(log->assumptions(),
              Contains(HasSubstr("the odometry of /a/odom is not used, because it is that of "
                                 "another robot than the scans of /b/scan")));
}

// ---- Several topics of one laser ----

struct RivalTopic {
  std::string name;
  std::function<void(RecordedScan&, int i)> disturb;  // of the scan i of the worse topic
  float noise_m = 0;                                  // standard deviation of the ranges of both topics
  unsigned seed = 0;
  friend void PrintTo(const RivalTopic& rival, std::ostream* out) { *out << rival.name; }
};

class TwoTopicsOfOneLaser : public testing::TestWithParam<RivalTopic> {
 protected:
  /// Records a drive through a room. `good` and `bad` are the topics of the laser, `first` comes first.
  static Recording drive(const std::string& good, const std::string& bad, bool bad_first, bool moves = true) {
    Recording recording{static_mount("laser", {0.1, 0, 0.2, 0, 0, 0})};
    const auto bearings = even_bearings(-2, 2, 161);
    std::mt19937 random(GetParam().seed);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 120; ++i) {
      const TimeUs time_us = 1'600'000'000'000'000 + i * 100'000;
      const double angle_rad = moves ? 0.05 * i + 0.4 * std::sin(0.25 * i) : 0;
      const mrpt::math::TPose2D pose{std::cos(angle_rad), std::sin(angle_rad) + 0.5, angle_rad + M_PI / 2};
      recording.emplace_back(
          RecordedPose{"/odom", time_us, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}});
      RecordedScan scan;
      scan.time_us = time_us;
      scan.angle_min_rad = -2;
      scan.angle_increment_rad = 0.025F;
      scan.ranges_m = SimulatedRoom().scan_from(pose, bearings).scan.ranges_m;
      RecordedScan disturbed = scan;
      scan.topic = good;
      disturbed.topic = bad;
      if (moves) GetParam().disturb(disturbed, i);
      for (RecordedScan* noisy : {&scan, &disturbed})
        for (float& range_m : noisy->ranges_m) range_m += GetParam().noise_m * normal(random);
      recording.emplace_back(bad_first ? disturbed : scan);
      recording.emplace_back(bad_first ? scan : disturbed);
    }
    return recording;
  }

  std::vector<std::string> assumptions_about(const Recording& recording) const {
    const TemporaryFolder folder;
    write_mcap(folder.path() / "bag", recording);
    const auto log = open_log(folder.path() / "bag");
    EXPECT_EQ(all_frames(*log).size(), 120U);
    return log->assumptions();
  }
};

TEST_P(TwoTopicsOfOneLaser, the_one_that_agrees_with_odometry_is_mapped) {
  for (const bool bad_first : {false, true})
    for (const auto& [good, bad] : {std::pair{"/scan", "/stable_scan"}, std::pair{"/stable_scan", "/scan"}})
      EXPECT_THAT(assumptions_about(drive(good, bad, bad_first)),
                  testing::ElementsAre(std::string("the scans of ") + bad + " are not used, because " + good +
                                       " has scans of the same laser, which agree better with odometry. "
                                       "Select topics with log.scan_topic"));
}

TEST_P(TwoTopicsOfOneLaser, are_chosen_by_name_if_the_robot_stands) {
  for (const bool first : {false, true})
    EXPECT_THAT(
        assumptions_about(drive("/scan", "/base_scan", first, false)),
        testing::ElementsAre("the scans of /base_scan are not used, because /scan has scans of the same "
                             "laser. Select topics with log.scan_topic"));
}

using NoisyTopicsOfOneLaser = TwoTopicsOfOneLaser;

TEST_P(NoisyTopicsOfOneLaser, are_chosen_by_name_if_only_noise_tells_them_apart) {
  for (const bool first : {false, true})
    EXPECT_THAT(
        assumptions_about(drive("/scan", "/base_scan", first)),
        testing::ElementsAre("the scans of /base_scan are not used, because /scan has scans of the same "
                             "laser. Select topics with log.scan_topic"));
}

RivalTopic equal_topic(unsigned seed) {
  return {"seed_" + std::to_string(seed), [](RecordedScan&, int) {}, 0.01F, seed};
}

INSTANTIATE_TEST_SUITE_P(Seeds, NoisyTopicsOfOneLaser,
                         testing::Values(equal_topic(1), equal_topic(2), equal_topic(3), equal_topic(4),
                                         equal_topic(5), equal_topic(6)),
                         [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Kinds, TwoTopicsOfOneLaser,
    testing::Values(
        RivalTopic{"late", [](RecordedScan& scan, int) { scan.time_us += 300'000; }},
        RivalTopic{"early", [](RecordedScan& scan, int) { scan.time_us -= 250'000; }},
        RivalTopic{"mirrored",
                   [](RecordedScan& scan, int) { std::reverse(scan.ranges_m.begin(), scan.ranges_m.end()); }},
        RivalTopic{"unsteady_stamps", [](RecordedScan& scan, int i) { scan.time_us += i % 3 * 30'000; }},
        RivalTopic{"wider_bearings",
                   [](RecordedScan& scan, int) {
                     scan.angle_min_rad *= 1.1F;
                     scan.angle_increment_rad *= 1.1F;
                   }},
        RivalTopic{"turned_to_and_fro",
                   [](RecordedScan& scan, int i) { scan.angle_min_rad += i % 2 == 0 ? 0.03F : 0; }}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace psi_slam
