// SPDX-License-Identifier: BSD-3-Clause
// Bags with several topics of odometry, of which some are silent or begin late.
#include "logs/rosbag/heard_odometry.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <string>

#include "bag_files.h"
#include "base/compression/compressed_file.h"
#include "log_files.h"
#include "logs/frames/look_over.h"
#include "logs/rosbag/rosbag_stream.h"
#include "same_frames.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;

/// When a second topic of odometry speaks, in seconds of a drive of 12 s.
struct SecondTopic {
  std::string name;
  std::function<bool(double at_s, int i)> speaks;  // i: number of the odometry
  bool is_used = false;
  friend void PrintTo(const SecondTopic& second, std::ostream* out) { *out << second.name; }
};

class BagWithASecondOdometry : public testing::TestWithParam<SecondTopic> {
 protected:
  /// Records a drive with odometry on /wheels. The topic /odom, which has the better name, says that the
  /// robot is 100 m away.
  static Recording drive(const std::function<bool(double at_s, int i)>& speaks) {
    Recording recording;
    int odometry = 0;
    for (Recorded message : recorded_run(240)) {
      auto* pose = std::get_if<RecordedPose>(&message);
      const bool is_odometry = pose != nullptr && !pose->is_transform();
      if (is_odometry) pose->topic = "/wheels";
      recording.push_back(message);
      if (!is_odometry || !speaks(seconds(pose->time_us - 1'600'000'000'000'000), odometry++)) continue;
      RecordedPose second = *pose;
      second.topic = "/odom";
      second.pose.y += 100;
      recording.emplace_back(second);
    }
    return recording;
  }

  static std::unique_ptr<LogReader> followed(const Path& path) {
    return open_rosbag_stream(std::make_unique<CompressedFile>(path), {}, kUsualLookOver_s);
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.mcap";
};

TEST_P(BagWithASecondOdometry, uses_the_one_that_speaks_in_a_file_as_in_a_stream) {
  write_mcap(path_, drive(GetParam().speaks));
  const auto file = open_log_reader(path_, {});
  const auto frame = file->next();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->has_odometry);
  EXPECT_EQ(frame->odom_T_robot.y > 50, GetParam().is_used);
  EXPECT_EQ(expect_same_frames(*open_log_reader(path_, {}), *followed(path_)), 240U);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BagWithASecondOdometry,
    testing::Values(SecondTopic{"late", [](double at_s, int) { return at_s > 8; }},
                    SecondTopic{"soon_after_the_beginning", [](double at_s, int) { return at_s > 4; }},
                    SecondTopic{"at_the_end", [](double at_s, int) { return at_s > 11.99; }},
                    SecondTopic{"once", [](double, int i) { return i == 0; }},
                    SecondTopic{"stops_early", [](double at_s, int) { return at_s < 1; }},
                    SecondTopic{"every_six_seconds", [](double, int i) { return i % 300 == 0; }},
                    SecondTopic{"always", [](double, int) { return true; }, true},
                    SecondTopic{"five_times_in_a_second", [](double, int i) { return i % 10 == 0; }, true}),
    [](const auto& tested) { return tested.param.name; });

TEST(BagWithASecondRobot, uses_the_odometry_of_the_first_in_a_file_as_in_a_stream) {
  // The scans of the second robot begin late, but its odometry is the first topic.
  Recording recording;
  for (Recorded message : recorded_run(240)) {
    if (topic_of(message) == "/tf_static") continue;
    const bool is_late = time_of(message) > 1'600'000'008'000'000;
    for (const char* robot : {"/b", "/a"}) {
      Recorded own = message;
      std::visit([&](auto& one) { one.topic = robot + one.topic, one.frame = robot + one.frame; }, own);
      auto* pose = std::get_if<RecordedPose>(&own);
      if (pose != nullptr) pose->child_frame = robot + pose->child_frame;
      if (pose != nullptr && robot == std::string("/b")) pose->pose.y += 100;
      if (pose != nullptr || is_late || robot == std::string("/a")) recording.push_back(own);
    }
  }
  const TemporaryFolder folder;
  const Path path = folder.path() / "run.mcap";
  write_mcap(path, recording);
  const auto file = open_log_reader(path, {});
  const auto live = open_rosbag_stream(std::make_unique<CompressedFile>(path), {}, kUsualLookOver_s);
  EXPECT_EQ(expect_same_frames(*file, *live), 240U);
  EXPECT_LT(open_log_reader(path, {})->next()->odom_T_robot.y, 50);
}

TEST(BagWithASecondGyroscope, uses_the_one_that_speaks_in_a_file_as_in_a_stream) {
  for (const double begins_s : {8.0, 1.0}) {
    Recording recording;
    for (const Recorded& message : recorded_run(240)) {
      if (topic_of(message) == "/odom") continue;
      recording.push_back(message);
      const double at_s = seconds(time_of(message) - 1'600'000'000'000'000);
      for (const char* topic : {"/imu", "/late_imu"})
        if (at_s > (topic == std::string("/imu") ? 0.0 : begins_s))
          recording.emplace_back(RecordedImu{topic, time_of(message), "laser", {0, 0, 0.3}});
    }
    const TemporaryFolder folder;
    const Path path = folder.path() / "run.mcap";
    for (const char* mount : {"known", "unknown"}) {
      SCOPED_TRACE(mount);
      write_mcap(path, recording);
      const auto file = open_log_reader(path, {});
      const auto live = open_rosbag_stream(std::make_unique<CompressedFile>(path), {}, kUsualLookOver_s);
      EXPECT_EQ(expect_same_frames(*file, *live), 240U);
      EXPECT_EQ(open_log_reader(path, {})->next()->imu_heading_rad.has_value(), begins_s > 5) << begins_s;
      recording.erase(recording.begin());
    }
  }
}

TEST(HeardOdometry, waits_for_the_first_odometry) {
  HeardOdometry heard({"/odom", "/wheels"}, 5);
  for (int i = 0; i < 100; ++i) heard.add_scan(i * 100'000);
  EXPECT_FALSE(heard.is_complete());
  heard.add("/wheels", {});
  heard.add("/odom", {});
  EXPECT_FALSE(heard.is_complete()) << "the other topic has just begun";
  for (int i = 100; i < 160; ++i) heard.add_scan(i * 100'000);
  EXPECT_TRUE(heard.is_complete());
  EXPECT_EQ(heard.first().size(), 2U);
}

}  // namespace
}  // namespace psi_slam
