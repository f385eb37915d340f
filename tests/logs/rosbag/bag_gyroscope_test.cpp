// SPDX-License-Identifier: BSD-3-Clause
// Gyroscopes in ROS bags.
#include <gmock/gmock.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bag_files.h"
#include "log_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Path = std::filesystem::path;

constexpr TimeUs kFirst_us = 1'600'000'000'000'000;

double true_heading_rad(TimeUs time_us) {
  return 0.8 * std::sin(2 * seconds(time_us - kFirst_us));
}

/// Recording of a robot without odometry that turns to and fro for two seconds: a scan every 50 ms, a rate
/// of its IMU every 5 ms. The IMU is turned on the robot by `mount`.
Recording turning_robot(const mrpt::math::TPose3D& mount = {0.1, 0, 0.2, 0, 0, 0}) {
  Recording recording{static_mount(), static_mount("imu", mount)};
  const auto rotation = mrpt::poses::CPose3D(mount).getRotationMatrix();
  for (TimeUs t = kFirst_us; t <= kFirst_us + 2'000'000; t += 5'000) {
    const double rate_radps = 1.6 * std::cos(2 * seconds(t - kFirst_us));
    RecordedImu imu;
    imu.time_us = t;
    for (int axis = 0; axis < 3; ++axis)
      imu.rate_radps[static_cast<std::size_t>(axis)] = rate_radps * rotation(2, axis);
    if (t % 50'000 == 0) {
      RecordedScan scan;
      scan.time_us = t + 2'000;
      recording.emplace_back(scan);
    }
    recording.emplace_back(imu);
  }
  return recording;
}

class BagGyroscopeTest : public testing::Test {
 protected:
  struct Log {
    std::vector<Frame> frames;
    std::vector<std::string> assumptions;
  };

  Log read(const Recording& recording, const LogOptions& options = {}) {
    write_mcap(path_, recording);
    return read_file_at(path_, options);
  }

  static Log read_file_at(const Path& path, const LogOptions& options = {}) {
    const auto source = open_log(path, options);
    Log log{all_frames(*source), {}};
    log.assumptions = source->assumptions();
    return log;
  }

  std::string sentence_about(const Recording& recording, const LogOptions& options) {
    return sentence_of([&] { read(recording, options); });
  }

  static void expect_true_headings(const Log& log) {
    ASSERT_EQ(log.frames.size(), 41U);
    for (std::size_t i = 0; i < 40; ++i) {
      const Frame& frame = log.frames[i];
      EXPECT_FALSE(frame.has_odometry);
      ASSERT_TRUE(frame.imu_heading_rad) << i;
      EXPECT_NEAR(*frame.imu_heading_rad, true_heading_rad(frame.time_us), 1e-3) << i;
    }
    EXPECT_FALSE(log.frames.back().imu_heading_rad) << "the scan is 2 ms after the last rate";
  }

  static void expect_no_headings(const Log& log) {
    for (const Frame& frame : log.frames) EXPECT_FALSE(frame.imu_heading_rad);
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.mcap";
};

TEST_F(BagGyroscopeTest, gives_the_headings_of_scans_in_every_encoding) {
  const std::vector<std::function<void()>> writers{
      [&] { write_ros1_bag(path_, turning_robot()); },
      [&] { write_mcap(path_, turning_robot()); },
      [&] {
        write_mcap(path_, turning_robot(), {"", 7, true, false});
      },
  };
  for (const auto& write : writers) {
    write();
    const Log log = read_file_at(path_);
    expect_true_headings(log);
    EXPECT_THAT(log.assumptions, IsEmpty());
  }
}

TEST_F(BagGyroscopeTest, may_hang_upside_down_or_sideways) {
  expect_true_headings(read(turning_robot({0, 0, 0, 0.4, 0, M_PI})));
  expect_true_headings(read(turning_robot({0, 0, 0, 0.4, 0, M_PI / 2})));
  expect_true_headings(read(turning_robot({0, 0, 0, 0.4, -1.2, 0.3})));
}

TEST_F(BagGyroscopeTest, is_assumed_upright_if_its_mount_is_unknown) {
  Recording recording = turning_robot();
  recording.erase(recording.begin() + 1);
  const Log log = read(recording);
  expect_true_headings(log);
  EXPECT_THAT(log.assumptions,
              ElementsAre("the z axis of the gyroscope of /imu is assumed to point up, because no transform "
                          "leads from \"base_link\" to \"imu\". Ignore the gyroscope with log.imu=none"));
}

TEST_F(BagGyroscopeTest, is_not_needed_with_odometry) {
  Recording recording = turning_robot();
  recording.insert(recording.begin() + 2,
                   RecordedPose{"/odom", kFirst_us, "odom", "base_link", {1, 2, 0, 0.5, 0, 0}});
  const Log log = read(recording);
  EXPECT_TRUE(log.frames.front().has_odometry);
  expect_no_headings(log);
  EXPECT_THAT(log.assumptions, IsEmpty());
  LogOptions options;
  options.odometry = "none";
  expect_true_headings(read(recording, options));
  options.odometry = "auto";
  options.imu = "imu";
  const Log named = read(recording, options);
  expect_no_headings(named);
  EXPECT_THAT(named.assumptions, ElementsAre(HasSubstr("the gyroscope of \"/imu\" is not used")));
}

TEST_F(BagGyroscopeTest, the_user_chooses_one_of_several) {
  Recording recording = turning_robot();
  for (std::size_t i = recording.size(); i-- > 0;) {
    const auto* imu = std::get_if<RecordedImu>(&recording[i]);
    if (imu == nullptr) continue;
    RecordedImu still = *imu;
    still.topic = "/camera/imu";
    still.rate_radps = {};
    recording.insert(recording.begin() + static_cast<std::ptrdiff_t>(i), still);
  }
  const Log none = read(recording);
  expect_no_headings(none);
  EXPECT_THAT(none.assumptions, ElementsAre(HasSubstr("because the log has several: ")));
  LogOptions options;
  for (const char* name : {"/imu", "imu"}) {
    options.imu = name;
    const Log chosen = read(recording, options);
    expect_true_headings(chosen);
    EXPECT_THAT(chosen.assumptions, IsEmpty());
  }
  options.imu = "none";
  const Log unwanted = read(recording, options);
  expect_no_headings(unwanted);
  EXPECT_THAT(unwanted.assumptions, IsEmpty());
  options.imu = "/gyro";
  EXPECT_EQ(sentence_about(recording, options),
            "log.imu is \"/gyro\", expected a topic of type sensor_msgs/Imu of " + path_.string() +
                ": /camera/imu, /imu");
}

TEST_F(BagGyroscopeTest, an_imu_without_angular_velocities_is_no_gyroscope) {
  Recording recording = turning_robot();
  for (Recorded& message : recording)
    if (auto* imu = std::get_if<RecordedImu>(&message)) imu->has_rate = false;
  const Log log = read(recording);
  expect_no_headings(log);
  EXPECT_THAT(log.assumptions, IsEmpty());
  LogOptions options;
  options.imu = "/imu";
  EXPECT_EQ(sentence_about(recording, options),
            "log.imu is \"/imu\", expected a topic of type sensor_msgs/Imu with angular velocities of " +
                path_.string() + ": it has none. Map without a gyroscope with log.imu=none");
}

TEST_F(BagGyroscopeTest, every_nth_scan_keeps_only_turns_that_are_known) {
  Recording recording = turning_robot();
  const auto is_missing = [](const Recorded& message) {
    const TimeUs t = time_of(message) - kFirst_us;
    return std::holds_alternative<RecordedImu>(message) && t > 420'000 && t < 1'000'000;
  };
  recording.erase(std::remove_if(recording.begin(), recording.end(), is_missing), recording.end());
  LogOptions options;
  options.every_nth_scan = 16;  // the scans at 0, 0.8 and 1.6 s
  const Log log = read(recording, options);
  ASSERT_EQ(log.frames.size(), 3U);
  EXPECT_TRUE(log.frames[0].imu_heading_rad);
  EXPECT_FALSE(log.frames[1].imu_heading_rad);
  options.every_nth_scan = 30;  // the scans at 0 and 1.5 s, on both sides of the gap
  const Log sparse = read(recording, options);
  ASSERT_EQ(sparse.frames.size(), 2U);
  EXPECT_TRUE(sparse.frames[0].imu_heading_rad);
  EXPECT_FALSE(sparse.frames[1].imu_heading_rad);
}

}  // namespace
}  // namespace psi_slam
