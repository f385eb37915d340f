// SPDX-License-Identifier: BSD-3-Clause
// Bags with two topics of one laser of which the mount of only one is stated.
#include <gmock/gmock.h>

#include <string>

#include "bag_files.h"
#include "log_files.h"
#include "logs/frames/look_over.h"
#include "logs/rosbag/rosbag_stream.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

enum class Motion { kOdometry, kTransforms, kNone };

/// Topic whose mount the transforms state, and the other topic of the laser.
struct Topics {
  std::string name;
  std::string mounted;
  std::string other;
  Motion motion;
  friend void PrintTo(const Topics& topics, std::ostream* out) { *out << topics.name; }
};

class OneMountOfTwoTopics : public testing::TestWithParam<Topics> {};

TEST_P(OneMountOfTwoTopics, is_used) {
  for (const bool other_first : {false, true}) {
    Recording recording;
    for (Recorded message : recorded_run()) {
      if (auto* pose = std::get_if<RecordedPose>(&message); pose != nullptr && !pose->is_transform()) {
        if (GetParam().motion == Motion::kNone) continue;
        if (GetParam().motion == Motion::kTransforms) pose->topic = "/tf";
      }
      const auto* scan = std::get_if<RecordedScan>(&message);
      if (scan == nullptr) {
        recording.push_back(message);
        continue;
      }
      RecordedScan mounted = *scan;
      mounted.topic = GetParam().mounted;
      RecordedScan other = *scan;
      other.topic = GetParam().other;
      other.frame = "lidar_link";
      recording.insert(recording.end(), {other_first ? other : mounted, other_first ? mounted : other});
    }
    const TemporaryFolder folder;
    write_mcap(folder.path() / "bag", recording);
    const auto log = open_log(folder.path() / "bag");
    const auto frames = all_frames(*log);
    ASSERT_EQ(frames.size(), 20U);
    EXPECT_NEAR(frames[3].scan.robot_T_laser.x, 0.2, 1e-9);
    EXPECT_TRUE(frames[3].companions.empty());
    EXPECT_THAT(log->assumptions(), testing::Contains(testing::HasSubstr("the scans of " + GetParam().other +
                                                                         " are not used, because")));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, OneMountOfTwoTopics,
    testing::Values(Topics{"long_and_odometry", "/stable_scan", "/scan", Motion::kOdometry},
                    Topics{"short_and_odometry", "/scan", "/stable_scan", Motion::kOdometry},
                    Topics{"long_and_transforms", "/stable_scan", "/scan", Motion::kTransforms},
                    Topics{"short_and_transforms", "/scan", "/stable_scan", Motion::kTransforms},
                    Topics{"long_and_no_odometry", "/stable_scan", "/scan", Motion::kNone},
                    Topics{"short_and_no_odometry", "/scan", "/stable_scan", Motion::kNone}),
    [](const auto& tested) { return tested.param.name; });

TEST(OneStatedMountOfTwoTopics, is_used) {
  for (const auto& [stated, other] :
       {std::pair{"/stable_scan", "/scan"}, std::pair{"/scan", "/stable_scan"}}) {
    for (const bool has_transform : {false, true}) {
      Recording recording;
      for (const Recorded& message : recorded_run()) {
        if (topic_of(message) == "/tf_static" && !has_transform) continue;
        recording.push_back(message);
        const auto* scan = std::get_if<RecordedScan>(&message);
        if (scan == nullptr) continue;
        RecordedScan stable = *scan;
        stable.topic = "/stable_scan";
        recording.emplace_back(stable);
      }
      const TemporaryFolder folder;
      write_mcap(folder.path() / "bag", recording);
      LogOptions options;
      options.laser_mounts = std::string(stated) + " 0.7 0 90";
      const auto log = open_log(folder.path() / "bag", options);
      const auto frames = all_frames(*log);
      ASSERT_EQ(frames.size(), 20U);
      EXPECT_NEAR(frames[3].scan.robot_T_laser.x, 0.7, 1e-9) << stated << has_transform;
    }
  }
}

}  // namespace
}  // namespace psi_slam
