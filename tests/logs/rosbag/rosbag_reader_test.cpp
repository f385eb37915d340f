// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>

#include "bag_files.h"
#include "base/compression/compressed_file.h"
#include "log_files.h"
#include "logs/frames/log_reader.h"
#include "logs/rosbag/rosbag_stream.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::TPose3D;
using testing::HasSubstr;
using Path = std::filesystem::path;

/// Writes the recording as a CARMEN log and returns the frames that are read from this log.
std::vector<Frame> carmen_frames(const Recording& recording, const TPose2D& mount = {0.2, 0, 0.3}) {
  TemporaryFolder folder;
  write_carmen(folder.path() / "log.clf", recording);
  LogOptions options;
  options.robot_T_laser = mount;
  return frames_of(folder.path() / "log.clf", options);
}

void expect_near(const TPose2D& pose, const TPose2D& expected) {
  EXPECT_NEAR(pose.x, expected.x, 1e-9);
  EXPECT_NEAR(pose.y, expected.y, 1e-9);
  EXPECT_NEAR(pose.phi, expected.phi, 1e-9);
}

void expect_same_frames(const std::vector<Frame>& frames, const std::vector<Frame>& expected) {
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].time_us, expected[i].time_us);
    expect_near(frames[i].odom_T_robot, expected[i].odom_T_robot);
    expect_near(frames[i].scan.robot_T_laser, expected[i].scan.robot_T_laser);
    EXPECT_EQ(frames[i].scan.ranges_m, expected[i].scan.ranges_m);
    EXPECT_EQ(*frames[i].scan.bearings_rad, *expected[i].scan.bearings_rad);
    EXPECT_EQ(frames[i].scan.max_range_m, expected[i].scan.max_range_m);
  }
}

// ---- Every kind of bag holds the same frames ----

struct Kind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

Kind ros1(const std::string& name, const std::string& compression) {
  return {name, [=](const Path& path, const Recording& r) {
            write_ros1_bag(path, r, {compression, 7, true});
          }};
}

Kind mcap(const std::string& name, const McapLayout& layout) {
  return {name, [=](const Path& path, const Recording& r) { write_mcap(path, r, layout); }};
}

/// Returns a kind of bag that is a folder of eleven files.
Kind folder(const std::string& name, const std::string& suffix, bool with_metadata) {
  return {name, [=](const Path& path, const Recording& recording) {
            std::filesystem::create_directory(path);
            std::string metadata = "rosbag2_bagfile_information:\n  version: 4\n  relative_file_paths:\n";
            for (std::size_t k = 0; k < 11; ++k) {
              const auto at = [&](std::size_t part) {
                return recording.begin() + static_cast<std::ptrdiff_t>(recording.size() * part / 11);
              };
              const std::string file = "run_" + std::to_string(k) + suffix;
              const Recording part(at(k), at(k + 1));
              suffix == ".db3" ? write_db3(path / file, part) : write_mcap(path / file, part);
              metadata += "    - " + file + "\n";
            }
            if (with_metadata) write_file(path / "metadata.yaml", metadata);
          }};
}

const std::vector<Kind> kKinds{
    ros1("ros1", "none"),
    ros1("ros1_bz2", "bz2"),
    ros1("ros1_lz4", "lz4"),
    {"ros1_gzipped",
     [](const Path& path, const Recording& recording) {
       write_ros1_bag(path, recording);
       write_gzipped(path, read_file(path));
     }},
    {"db3", [](const Path& path, const Recording& recording) { write_db3(path, recording); }},
    {"db3_big_endian",
     [](const Path& path, const Recording& recording) { write_db3(path, recording, false); }},
    mcap("mcap", {}),
    mcap("mcap_lz4", {"lz4", 7, true, true}),
    mcap("mcap_zstd", {"zstd", 7, true, true}),
    mcap("mcap_without_chunks", {"", 0, true, true}),
    mcap("mcap_without_summary", {"zstd", 100, false, true}),
    mcap("mcap_big_endian", {"", 7, true, false}),
    folder("folder_of_db3", ".db3", true),
    folder("folder_of_mcap", ".mcap", true),
    folder("folder_without_metadata", ".mcap", false),
};

class EveryKindOfBag : public testing::TestWithParam<Kind> {};

TEST_P(EveryKindOfBag, holds_the_frames_of_the_same_carmen_log) {
  const TemporaryFolder folder;
  const Recording recording = recorded_run(40);
  GetParam().write(folder.path() / "bag", recording);
  expect_same_frames(frames_of(folder.path() / "bag"), carmen_frames(recording));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKindOfBag, testing::ValuesIn(kKinds),
                         [](const auto& tested) { return tested.param.name; });

class BagOfRosItself : public testing::TestWithParam<const char*> {};

TEST_P(BagOfRosItself, holds_the_frames_of_the_same_carmen_log) {
  const TemporaryFolder folder;
  const Recording recording = recorded_run(200);
  write_carmen(folder.path() / "log.clf", recording);
  const std::string command = std::string("/usr/bin/python3 " PSI_SLAM_ROSBAG_TESTS "/write_ros1_bag.py '") +
                              (folder.path() / "log.clf").string() + "' '" +
                              (folder.path() / "run.bag").string() + "' " + GetParam();
  const int status = std::system(command.c_str());
  if (WEXITSTATUS(status) == 77)
    GTEST_SKIP()
        << "needs Debian's python3-rosbag, python3-nav-msgs, python3-sensor-msgs and python3-tf2-msgs";
  ASSERT_EQ(status, 0);
  expect_same_frames(frames_of(folder.path() / "run.bag"), carmen_frames(recording));
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagOfRosItself, testing::Values("none", "bz2", "lz4"),
                         [](const auto& tested) { return std::string(tested.param); });

// ---- Topics and frames ----

class RosbagReaderTest : public testing::Test {
 protected:
  std::vector<Frame> read(const Recording& recording, const LogOptions& options = {}) {
    write_mcap(path_, recording);
    return frames_of(path_, options);
  }

  std::string sentence_about(const Recording& recording, const LogOptions& options = {}) {
    return sentence_of([&] { read(recording, options); });
  }

  /// Returns the recording of a robot that stands at the pose (1, 2, 0.5), with one scan.
  static Recording one_scan(const RecordedScan& scan, const RecordedPose& mount = static_mount()) {
    return {mount, RecordedPose{"/odom", 1'000'000, "odom", "base_link", {1, 2, 0, 0.5, 0, 0}}, scan};
  }

  static RecordedScan scan_at(TimeUs time_us = 1'000'000) {
    RecordedScan scan;
    scan.time_us = time_us;
    return scan;
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.mcap";
};

TEST_F(RosbagReaderTest, reads_the_topics_that_the_user_selects) {
  Recording recording = recorded_run();
  RecordedScan rear = scan_at(1'600'000'000'100'000);
  rear.topic = "/rear_scan";
  rear.ranges_m = {9, 9};
  recording.insert(recording.begin() + 5, rear);
  LogOptions options;
  options.robot_T_laser = TPose2D(0.2, 0, 0.3);
  EXPECT_EQ(sentence_about(recording, options), path_.string() +
                                                    " has several topics of type sensor_msgs/LaserScan: "
                                                    "/scan, /rear_scan. Select one with log.scan_topic")
      << "the mount that the user states is of a single laser";
  options.robot_T_laser.reset();
  for (const char* name : {"/rear_scan", "rear_scan"}) {
    options.scan_topic = name;
    EXPECT_EQ(read(recording, options).size(), 1U);
  }
  options.scan_topic = "/scan";
  EXPECT_EQ(read(recording, options).size(), 20U);
  options.scan_topic = "/front";
  EXPECT_EQ(sentence_about(recording, options),
            "log.scan_topic is \"/front\", expected a topic of type sensor_msgs/LaserScan of " +
                path_.string() + ": /scan, /rear_scan");
}

TEST_F(RosbagReaderTest, odometry_may_be_a_transform) {
  Recording recording = recorded_run();
  for (Recorded& message : recording) {
    auto* pose = std::get_if<RecordedPose>(&message);
    if (pose == nullptr || pose->topic != "/odom") continue;
    pose->topic = "/tf";
    pose->child_frame = "base_footprint";
  }
  recording.insert(recording.begin(),
                   RecordedPose{"/tf_static", 1, "base_footprint", "base_link", {0.1, 0, 0.2, 0, 0, 0}});
  recording.insert(recording.begin() + 3, RecordedPose{"/tf", 2, "map", "odom", {7, 7, 0, 1, 0, 0}});
  expect_same_frames(read(recording), carmen_frames(recorded_run(), {0.3, 0, 0.3}));
  LogOptions options;
  options.odom_frame = "wheels";
  EXPECT_THAT(sentence_about(recording, options), HasSubstr("base_footprint < odom"));
  options.odom_frame = "map";
  expect_near(read(recording, options).front().odom_T_robot, {7, 7, 1});  // the pose of odom in map
}

TEST_F(RosbagReaderTest, the_odometry_topic_may_be_a_topic_of_transforms) {
  Recording recording = recorded_run();
  recording.insert(recording.begin(),
                   RecordedPose{"/tf", 1'600'000'000'000'000, "odom", "base_link", {5, 6, 0, 0, 0, 0}});
  EXPECT_EQ(read(recording).front().odom_T_robot.y, carmen_frames(recorded_run()).front().odom_T_robot.y);
  LogOptions options;
  options.odometry = "tf";
  EXPECT_EQ(read(recording, options).back().odom_T_robot, TPose2D(5, 6, 0));
}

TEST_F(RosbagReaderTest, accepts_leading_slashes_and_a_mount_on_tf_after_the_first_scan) {
  Recording recording = recorded_run();
  recording.erase(recording.begin());
  RecordedPose mount = static_mount("/laser");
  mount.topic = "/tf";
  mount.frame = "/base_link";
  recording.insert(recording.begin() + 9, mount);
  expect_same_frames(read(recording), carmen_frames(recorded_run()));
}

TEST_F(RosbagReaderTest, laser_and_robot_may_have_a_common_parent_frame) {
  Recording recording = recorded_run();
  recording.erase(recording.begin());
  RecordedPose mount = static_mount();
  mount.frame = "body";
  recording.insert(recording.begin(),
                   {mount, RecordedPose{"/tf_static", 1, "body", "base_link", {-1, 0, 0, 0, 0, 0}}});
  expect_same_frames(read(recording), carmen_frames(recorded_run(), {1.2, 0, 0.3}));
}

TEST_F(RosbagReaderTest, mirrors_the_bearings_of_a_laser_mounted_upside_down) {
  const auto frame = read(one_scan(scan_at(), static_mount("laser", {0.2, 0.1, 0.4, 0.3, 0, M_PI}))).front();
  EXPECT_NEAR(frame.scan.robot_T_laser.phi, 0.3, 1e-9);
  EXPECT_THAT(*frame.scan.bearings_rad, testing::ElementsAre(1.0F, 0.5F, 0.0F, -0.5F, -1.0F));
  LogOptions options;
  options.mirrored = true;
  EXPECT_EQ(read(one_scan(scan_at(), static_mount("laser", {0, 0, 0, 0, 0, M_PI})), options)
                .front()
                .scan.bearings_rad->front(),
            -1.0F)
      << "the bearings are mirrored twice";
  EXPECT_THAT(sentence_about(one_scan(scan_at(), static_mount("laser", {0, 0, 0, 0, 0, 1}))),
              HasSubstr("the laser is tilted by 57 degrees"));
}

TEST_F(RosbagReaderTest, combines_all_lasers_with_known_mounts) {
  Recording recording = recorded_run();
  recording.insert(recording.begin(), static_mount("rear", {-0.3, 0, 0.2, M_PI, 0, 0}));
  for (std::size_t i = recording.size(); i-- > 0;) {
    const auto* scan = std::get_if<RecordedScan>(&recording[i]);
    if (scan == nullptr) continue;
    RecordedScan rear = *scan;
    rear.topic = "/rear_scan";
    rear.frame = "rear";
    RecordedScan filtered = *scan;
    filtered.topic = "/scan_filtered";
    RecordedScan unknown = *scan;
    unknown.topic = "/arm_scan";
    unknown.frame = "arm";
    recording.insert(recording.begin() + static_cast<std::ptrdiff_t>(i) + 1, {rear, filtered, unknown});
  }
  write_mcap(path_, recording);
  const auto log = open_log(path_);
  const std::vector<Frame> frames = all_frames(*log);
  ASSERT_EQ(frames.size(), 20U);
  for (const Frame& frame : frames) {
    EXPECT_NEAR(frame.scan.robot_T_laser.x, 0.2, 1e-9);
    ASSERT_EQ(frame.companions.size(), 1U);
    EXPECT_NEAR(frame.companions[0].scan.robot_T_laser.x, -0.3, 1e-9);
  }
  EXPECT_THAT(log->assumptions(),
              testing::ElementsAre(HasSubstr("the scans of /arm_scan are not used, because the mount"),
                                   HasSubstr("the scans of /scan_filtered are not used, because /scan has")));
}

TEST_F(RosbagReaderTest, one_of_several_lasers_suffices_if_no_mount_is_known) {
  Recording recording = recorded_run();
  recording.erase(recording.begin());
  RecordedScan rear = scan_at(1'600'000'000'100'000);
  rear.topic = "/rear_scan";
  rear.frame = "rear";
  recording.insert(recording.begin() + 5, rear);
  write_mcap(path_, recording);
  const auto log = open_log(path_);
  EXPECT_EQ(all_frames(*log).size(), 20U);
  EXPECT_THAT(log->assumptions(),
              testing::ElementsAre(HasSubstr("the scans of /rear_scan are not used"),
                                   HasSubstr("the laser of /scan is assumed at the robot's centre")));
}

TEST_F(RosbagReaderTest, assumes_the_mount_that_the_bag_does_not_state) {
  Recording recording = recorded_run();
  recording.erase(recording.begin());
  write_mcap(path_, recording);
  const auto log = open_log(path_);
  expect_same_frames(all_frames(*log), carmen_frames(recorded_run(), {0, 0, 0}));
  EXPECT_THAT(
      log->assumptions(),
      testing::ElementsAre("the laser of /scan is assumed at the robot's centre, facing ahead, because no "
                           "transform leads from \"base_link\" to \"laser\". State its mount with "
                           "log.laser_x_m, log.laser_y_m and log.laser_yaw_deg"));
  LogOptions options;
  options.base_frame = "robot";
  EXPECT_EQ(sentence_about(recording, options),
            path_.string() +
                " does not state where the laser of /scan is mounted: no transform leads from \"robot\" to "
                "\"laser\". Name the robot's frame with log.base_frame, or state the mount with "
                "log.laser_x_m, log.laser_y_m and log.laser_yaw_deg. Transforms of the bag: none");
  options.base_frame.clear();
  options.robot_T_laser = TPose2D(0.2, 0, 0.3);
  expect_same_frames(read(recording, options), carmen_frames(recorded_run()));
  options.robot_T_laser.reset();
  options.base_frame = "laser";
  EXPECT_EQ(read(recording, options).front().scan.robot_T_laser, TPose2D(0, 0, 0));
}

TEST_F(RosbagReaderTest, readings_without_a_return_are_marked_and_scans_may_change_their_shape) {
  const float inf = std::numeric_limits<float>::infinity();
  RecordedScan first = scan_at();
  first.ranges_m = {inf, -inf, std::nanf(""), 0.05F, 0, -1, 30, 29.5F, 1000};
  RecordedScan second = scan_at(1'100'000);
  second.angle_increment_rad = -0.25F;
  second.ranges_m = {1, 2};
  RecordedScan empty = scan_at(1'050'000);
  empty.ranges_m.clear();
  Recording recording = one_scan(first);
  recording.insert(recording.end(), {empty, second});
  const auto frames = read(recording);
  ASSERT_EQ(frames.size(), 2U) << "an empty scan is skipped";
  ASSERT_EQ(frames[0].scan.ranges_m.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(std::isfinite(frames[0].scan.ranges_m[i]), i == 7) << i;
    EXPECT_EQ(std::isinf(frames[0].scan.ranges_m[i]), i == 0 || i == 6 || i == 8) << i;
  }
  EXPECT_THAT(*frames[1].scan.bearings_rad, testing::ElementsAre(-1.0F, -1.25F));
}

TEST_F(RosbagReaderTest, the_first_of_several_echoes_is_the_range) {
  Recording recording = recorded_run();
  for (Recorded& message : recording)
    if (auto* scan = std::get_if<RecordedScan>(&message)) scan->multi_echo = true;
  expect_same_frames(read(recording), carmen_frames(recorded_run()));
  write_ros1_bag(path_, recording);
  expect_same_frames(frames_of(path_), carmen_frames(recorded_run()));
}

TEST_F(RosbagReaderTest, topics_may_lack_the_leading_slash) {
  Recording recording = recorded_run();
  for (Recorded& message : recording)
    if (topic_of(message) != "/tf_static") std::visit([](auto& one) { one.topic.erase(0, 1); }, message);
  LogOptions options;
  options.scan_topic = "/scan";
  options.odometry = "/odom";
  expect_same_frames(read(recording, options), carmen_frames(recorded_run()));
}

TEST_F(RosbagReaderTest, a_message_without_a_stamp_has_the_time_of_its_recording) {
  write_ros1_bag(path_, one_scan(scan_at(0)));
  std::string bytes = read_file(path_);
  const std::string recorded_at_0 = "time=" + ros1_time(0);
  bytes.replace(bytes.find(recorded_at_0), recorded_at_0.size(), "time=" + ros1_time(7'000'000));
  write_file(path_, bytes);
  const auto frames = frames_of(path_);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].time_us, 7'000'000);
}

TEST_F(RosbagReaderTest, odometry_may_be_a_transform_that_leads_to_no_laser) {
  Recording recording = recorded_run();
  recording.erase(recording.begin());
  for (Recorded& message : recording)
    if (auto* pose = std::get_if<RecordedPose>(&message)) pose->topic = "/tf";
  recording.insert(recording.begin(), RecordedPose{"/tf", 1, "odom", "map", {7, 7, 0, 1, 0, 0}});
  const auto frames = read(recording);
  const auto expected = carmen_frames(recorded_run(), {0, 0, 0});
  ASSERT_EQ(frames.size(), expected.size());
  EXPECT_TRUE(frames.back().has_odometry);
  expect_near(frames.back().odom_T_robot, expected.back().odom_T_robot);
}

TEST_F(RosbagReaderTest, chooses_one_of_several_topics_of_odometry) {
  Recording recording = recorded_run();
  recording.insert(recording.begin(),
                   RecordedPose{"/filtered", 1'600'000'000'000'000, "odom", "base_link", {5, 6, 0, 0, 0, 0}});
  write_mcap(path_, recording);
  const auto log = open_log(path_);
  expect_same_frames(all_frames(*log), carmen_frames(recorded_run()));
  EXPECT_THAT(log->assumptions(), testing::ElementsAre(HasSubstr("odometry comes from /odom")));
  LogOptions options;
  options.odometry = "filtered";
  EXPECT_EQ(read(recording, options).back().odom_T_robot, TPose2D(5, 6, 0));
}

TEST_F(RosbagReaderTest, odometry_may_be_missing_or_unwanted) {
  const auto expect_scans_alone = [&](const Recording& recording, const LogOptions& options,
                                      const TPose2D& mount) {
    const auto frames = read(recording, options);
    ASSERT_EQ(frames.size(), 20U);
    for (const Frame& frame : frames) {
      EXPECT_FALSE(frame.has_odometry);
      expect_near(frame.scan.robot_T_laser, mount);
    }
  };
  LogOptions none;
  none.odometry = "none";
  expect_scans_alone(recorded_run(), none, {0.2, 0, 0.3});
  Recording recording;
  for (const Recorded& message : recorded_run())
    if (topic_of(message) != "/odom") recording.push_back(message);
  expect_scans_alone(recording, {}, {0.2, 0, 0.3});
  recording.erase(recording.begin());
  expect_scans_alone(recording, {}, {0, 0, 0});
  recording.insert(recording.begin(), RecordedPose{"/tf", 1, "map", "camera", {7, 7, 0, 1, 0, 0}});
  expect_scans_alone(recording, {}, {0, 0, 0});
  LogOptions named;
  named.odometry = "/odom";
  EXPECT_THAT(sentence_about(recording, named), HasSubstr("log.odometry is \"/odom\", expected a topic"));
  named.odometry = "/tf";
  EXPECT_THAT(sentence_about(recording, named),
              testing::AllOf(HasSubstr("has no odometry, expected a transform from a frame named like"),
                             HasSubstr("log.odometry=none"), HasSubstr("camera < map")));
}

TEST_F(RosbagReaderTest, reports_missing_scans) {
  Recording recording = recorded_run();
  const auto without = [&](const char* topic) {
    Recording rest;
    for (const Recorded& message : recording)
      if (topic_of(message) != topic) rest.push_back(message);
    return rest;
  };
  EXPECT_EQ(sentence_about(without("/scan")),
            path_.string() +
                " has no laser scans, expected a topic of type sensor_msgs/LaserScan; found /tf_static "
                "(tf2_msgs/TFMessage), /odom (nav_msgs/Odometry). Record the scans with the bag");
}

TEST_F(RosbagReaderTest, skips_and_reports_odometry_with_an_invalid_pose) {
  Recording recording = recorded_run();
  RecordedPose invalid{"/odom", 1'600'000'000'500'000, "odom", "base_link", {}};
  invalid.pose.x = std::nan("");
  recording.insert(recording.begin() + 1, invalid);
  recording.insert(recording.begin() + 30, invalid);
  write_mcap(path_, recording);
  const auto log = open_log(path_);
  expect_same_frames(all_frames(*log), carmen_frames(recorded_run()));
  EXPECT_EQ(log->skipped_lines().count, 2U);
  EXPECT_THAT(log->skipped_lines().sentence(),
              testing::AllOf(testing::StartsWith("2 messages of the log"), HasSubstr("run.mcap: byte"),
                             HasSubstr("the odometry on /odom is not finite")));
  const Recording all_invalid{static_mount(), invalid, scan_at()};
  write_mcap(path_, all_invalid);
  const auto alone = open_log(path_);
  EXPECT_FALSE(all_frames(*alone).at(0).has_odometry);
  EXPECT_THAT(alone->assumptions(),
              testing::ElementsAre(HasSubstr("the odometry on /odom is not finite, or the length")));
  LogOptions options;
  options.odometry = "/odom";
  EXPECT_THAT(sentence_about(all_invalid, options), HasSubstr("the odometry on /odom is not finite"));
}

/// Makes one scan of a recording invalid.
struct InvalidScan {
  std::string name;
  std::function<void(RecordedScan&)> damage;
  std::string sentence;  // part of the message
  friend void PrintTo(const InvalidScan& invalid, std::ostream* out) { *out << invalid.name; }
};

class OneInvalidScan : public testing::TestWithParam<InvalidScan> {
 protected:
  /// Writes a bag of 20 scans whose scan `number` is invalid.
  Path write(std::size_t number) {
    Recording recording = recorded_run();
    for (Recorded& message : recording)
      if (auto* scan = std::get_if<RecordedScan>(&message); scan != nullptr && number-- == 0)
        GetParam().damage(*scan);
    write_ros1_bag(path_, recording);
    // The count of a scan with seven ranges becomes wrong: no writer of tests writes such a message.
    std::string bytes = read_file(path_);
    const std::string seven_ranges = ros1_packed(std::uint32_t{7}) + ros1_packed(1.5F);
    if (const auto at = bytes.find(seven_ranges); at != std::string::npos)
      write_file(path_, bytes.replace(at, 4, ros1_packed(std::uint32_t{70'000})));
    return path_;
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.bag";
};

TEST_P(OneInvalidScan, is_skipped_and_counted_in_a_file_as_in_a_stream) {
  std::vector<Frame> expected = carmen_frames(recorded_run());
  for (const std::size_t number : {0U, 1U, 9U, 19U}) {
    const Path path = write(number);
    const auto file = open_log(path, {});
    const auto frames = all_frames(*file);
    std::vector<Frame> others = expected;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(number));
    for (std::size_t i = 0; i < others.size(); ++i) others[i].index = i;
    expect_same_frames(frames, others);
    EXPECT_EQ(file->skipped_lines().count, 1U);
    EXPECT_THAT(file->skipped_lines().first, HasSubstr(GetParam().sentence));
    constexpr double kLookOver_s = 0.2;
    const auto live = open_rosbag_stream(std::make_unique<CompressedFile>(path), {}, kLookOver_s);
    EXPECT_EQ(all_frames(*live).size(), frames.size());
    EXPECT_EQ(live->skipped_lines().first, file->skipped_lines().first);
  }
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Kinds, OneInvalidScan,
    testing::Values(
        InvalidScan{"infinite_increment", [](RecordedScan& s) { s.angle_increment_rad = kInfinity; },
                    "the scan's angles start at -1.000000 in steps of inf radians"},
        InvalidScan{"no_increment", [](RecordedScan& s) { s.angle_increment_rad = 0; }, "in steps of 0.0"},
        InvalidScan{"nan_start", [](RecordedScan& s) { s.angle_min_rad = std::nanf(""); }, "start at nan"},
        InvalidScan{"degrees", [](RecordedScan& s) { s.angle_increment_rad = 90; }, "two turns"},
        InvalidScan{"truncated", [](RecordedScan& s) { s.ranges_m.assign(7, 1.5F); },
                    "it states 70000 numbers"}),
    [](const auto& tested) { return tested.param.name; });

TEST_F(RosbagReaderTest, reports_the_place_of_a_scan_with_invalid_angles) {
  RecordedScan scan = scan_at();
  scan.angle_increment_rad = 0;
  EXPECT_EQ(
      sentence_about(one_scan(scan)),
      path_.string() +
          ": byte 33, byte 1148 of the chunk: the scan's angles start at -1.000000 in steps of 0.000000 "
          "radians, expected finite angles and a step other than 0. Correct the laser's driver");
}

}  // namespace
}  // namespace psi_slam
