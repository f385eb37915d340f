// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>

#include "log_files.h"
#include "logs/frames/log_reader.h"
#include "rawlog_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr TimeUs kStart = 1'464'602'099'833'205;  // a recent time that is not a whole number of milliseconds

class RawlogReaderTest : public testing::Test {
 protected:
  std::vector<Frame> read(const RawlogObjects& objects, const LogOptions& options = {}) {
    write_rawlog(path_, objects);
    const auto reader = open_rawlog(path_, options);
    auto frames = all_frames(*reader);
    EXPECT_EQ(reader->progress(), 1.0);
    contents_ = reader->contents();
    return frames;
  }

  std::string sentence_about(const RawlogObjects& objects, const LogOptions& options = {}) {
    return sentence_of([&] { read(objects, options); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.rawlog";
  LogContents contents_;
};

void expect_pose(const TPose2D& found, const TPose2D& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-9);
  EXPECT_NEAR(found.y, expected.y, 1e-9);
  EXPECT_NEAR(found.phi, expected.phi, 1e-9);
}

TEST_F(RawlogReaderTest, sums_the_increments_of_actions) {
  const auto frames = read({sensory_frame({range_scan(kStart)}), movement({1, 0, M_PI / 2}),
                            sensory_frame({range_scan(kStart + 1)}), movement({2, 1, 0.25}),
                            movement({0, 0, 0.25}), sensory_frame({range_scan(kStart + 200'002)})});
  ASSERT_EQ(frames.size(), 3U);
  expect_pose(frames[0].odom_T_robot, {0, 0, 0});
  expect_pose(frames[1].odom_T_robot, {1, 0, M_PI / 2});
  expect_pose(frames[2].odom_T_robot, {0, 2, M_PI / 2 + 0.5});
  EXPECT_EQ(frames[0].time_us, kStart);
  EXPECT_EQ(frames[1].time_us, kStart + 1);
  EXPECT_EQ(frames[2].time_us, kStart + 200'002);
  EXPECT_EQ(frames[2].index, 2U);
  EXPECT_EQ(frames[2].scan.ranges_m, (std::vector<float>{1, 2, 3, 4, 5}));
  EXPECT_EQ(contents_.laser, "LASER");
}

TEST_F(RawlogReaderTest, interpolates_absolute_odometry) {
  const auto frames = read({range_scan(kStart), odometry(kStart + 100, {1, 0, 0}), range_scan(kStart + 125),
                            odometry(kStart + 200, {2, 4, 0.4}), range_scan(kStart + 300)});
  ASSERT_EQ(frames.size(), 3U);
  expect_pose(frames[0].odom_T_robot, {1, 0, 0});
  expect_pose(frames[1].odom_T_robot, {1.25, 1, 0.1});
  expect_pose(frames[2].odom_T_robot, {2, 4, 0.4});
  EXPECT_EQ(frames[2].index, 2U);
}

TEST_F(RawlogReaderTest, finds_absolute_odometry_in_sensory_frames) {
  const auto frames = read({sensory_frame({odometry(kStart, {1, 0, 0}), range_scan(kStart)}),
                            sensory_frame({range_scan(kStart + 50), odometry(kStart + 100, {3, 0, 0})})});
  ASSERT_EQ(frames.size(), 2U);
  expect_pose(frames[1].odom_T_robot, {2, 0, 0});
}

TEST_F(RawlogReaderTest, uses_one_kind_of_odometry_only) {
  const auto frames =
      read({movement({1, 0, 0}), sensory_frame({range_scan(kStart), odometry(kStart, {9, 9, 0})}),
            movement({1, 0, 0}), sensory_frame({range_scan(kStart), odometry(kStart, {9, 9, 0})})});
  expect_pose(frames.at(1).odom_T_robot, {2, 0, 0});
}

TEST_F(RawlogReaderTest, uses_the_mean_of_other_movements) {
  mrpt::obs::CActionRobotMovement2D action;
  action.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  action.poseChange = mrpt::poses::CPosePDF::Ptr(
      std::make_shared<mrpt::poses::CPosePDFGaussian>(mrpt::poses::CPose2D(0.5, 0, 0)));
  const auto frames =
      read({mrpt::obs::CActionCollection::Create(action), sensory_frame({range_scan(kStart)})});
  expect_pose(frames.at(0).odom_T_robot, {0.5, 0, 0});
}

TEST_F(RawlogReaderTest, reads_one_laser_of_several) {
  const RawlogObjects objects{
      movement({1, 0, 0}), sensory_frame({range_scan(kStart, "FRONT"), range_scan(kStart + 1, "REAR")}),
      movement({1, 0, 0}), sensory_frame({range_scan(kStart + 2, "FRONT"), range_scan(kStart + 3, "REAR")})};
  EXPECT_EQ(read(objects).at(1).time_us, kStart + 2);
  EXPECT_EQ(contents_.other_lasers.at("REAR"), 2U);
  LogOptions options;
  options.laser = "REAR";
  const auto frames = read(objects, options);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].time_us, kStart + 3);
  expect_pose(frames[1].odom_T_robot, {2, 0, 0});
  options.laser = "LEFT";
  EXPECT_EQ(sentence_about(objects, options), "log.laser is \"LEFT\", expected the label of a laser of " +
                                                  path_.string() + ": \"FRONT\", \"REAR\"");
}

TEST_F(RawlogReaderTest, combines_lasers_at_different_poses) {
  const auto scan_at = [](const char* label, double x_m, double pitch_rad = 0) {
    auto scan = range_scan(kStart, label);
    scan->sensorPose = mrpt::poses::CPose3D(x_m, 0, 0, 0, pitch_rad, 0);
    return scan;
  };
  read({movement({1, 0, 0}), sensory_frame({scan_at("FRONT", 0.2), scan_at("REAR", -0.2)})});
  EXPECT_EQ(contents_.laser, "FRONT, REAR");
  EXPECT_TRUE(contents_.several_lasers);
  EXPECT_EQ(contents_.laser_names.front().front(), "FRONT");
  EXPECT_THAT(contents_.assumptions, testing::ElementsAre(testing::HasSubstr("FRONT, REAR are combined")));

  read({movement({1, 0, 0}), sensory_frame({scan_at("A", 0.2), scan_at("TILTED", 0.1, 1.0)})});
  EXPECT_EQ(contents_.laser, "A");
  read({movement({1, 0, 0}), sensory_frame({scan_at("A", 0.2), scan_at("MOVING", 0.1)}),
        sensory_frame({scan_at("MOVING", 0.2)})});
  EXPECT_EQ(contents_.laser, "A");
  read({movement({1, 0, 0}), sensory_frame({scan_at("A", 0.2), scan_at("A", -0.2), scan_at("B", 0)})});
  EXPECT_EQ(contents_.laser, "A") << "the first laser moves";
  read({movement({1, 0, 0}), sensory_frame({scan_at("A", 0.2), scan_at("B,C", -0.2), scan_at("D", 0.3)})});
  EXPECT_EQ(contents_.laser, "A, D");
  EXPECT_EQ(contents_.other_lasers.at("B,C"), 1U) << "log.laser cannot name it";

  RawlogObjects slow{movement({1, 0, 0})};
  for (int i = 0; i < 150; ++i) slow.push_back(sensory_frame({scan_at("FAST", 0.2)}));
  slow.push_back(sensory_frame({scan_at("SLOW", -0.2)}));
  read(slow);
  EXPECT_EQ(contents_.laser, "FAST, SLOW");
  LogOptions all;
  all.laser = "all";
  read(slow, all);
  EXPECT_EQ(contents_.laser, "FAST, SLOW");

  LogOptions options;
  options.robot_T_laser = TPose2D{0.1, 0, 0};
  read({movement({1, 0, 0}), sensory_frame({scan_at("FRONT", 0.2), scan_at("REAR", -0.2)})}, options);
  EXPECT_EQ(contents_.laser, "FRONT") << "the mount is for a single laser";
  options = {};
  options.laser_mounts = "REAR -0.3 0 180";
  read({movement({1, 0, 0}), sensory_frame({range_scan(kStart, "FRONT"), range_scan(kStart, "REAR")})},
       options);
  EXPECT_EQ(contents_.laser, "FRONT, REAR");
}

TEST_F(RawlogReaderTest, reads_several_scans_of_one_laser_in_one_sensory_frame) {
  EXPECT_EQ(read({movement({1, 0, 0}), sensory_frame({range_scan(kStart), range_scan(kStart + 7)})}).size(),
            2U);
}

TEST_F(RawlogReaderTest, ignores_other_observations) {
  EXPECT_EQ(read({mrpt::obs::CObservationComment::Create(), movement({1, 0, 0}),
                  sensory_frame({mrpt::obs::CObservationComment::Create(), range_scan(kStart)})})
                .size(),
            1U);
}

TEST_F(RawlogReaderTest, rounds_time_to_the_nearest_microsecond) {
  const auto scan = range_scan(kStart);
  scan->timestamp += mrpt::Clock::duration(6);
  EXPECT_EQ(read({movement({1, 0, 0}), sensory_frame({scan})}).at(0).time_us, kStart + 1);
}

TEST_F(RawlogReaderTest, odometry_may_be_missing_or_unwanted) {
  LogOptions none;
  none.odometry = "none";
  const auto scan = range_scan(kStart);
  for (const auto& frames :
       {read({scan, scan}), read({movement({1, 0, 0}), sensory_frame({scan, scan})}, none)}) {
    ASSERT_EQ(frames.size(), 2U);
    for (const Frame& frame : frames) EXPECT_FALSE(frame.has_odometry);
  }
}

TEST_F(RawlogReaderTest, a_gyroscope_gives_the_headings_of_scans_without_odometry) {
  const mrpt::poses::CPose3D upside_down(0, 0, 0, 0, 0, M_PI);
  const auto log_with = [&](const std::string& label) {
    RawlogObjects objects;
    for (TimeUs t = 0; t <= 1'000'000; t += 10'000) {
      objects.push_back(imu_rate(kStart + t, -0.5, label, upside_down));
      if (t % 100'000 == 0) objects.push_back(sensory_frame({range_scan(kStart + t + 5'000)}));
    }
    return objects;
  };
  const auto expect_headings = [](const std::vector<Frame>& frames) {
    ASSERT_EQ(frames.size(), 11U);
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_FALSE(frames[i].has_odometry);
      EXPECT_NEAR(frames[i].imu_heading_rad.value(), 0.05 * static_cast<double>(i) + 0.0025, 1e-9);
    }
    EXPECT_FALSE(frames[10].imu_heading_rad);
  };
  expect_headings(read(log_with("IMU")));
  EXPECT_TRUE(contents_.assumptions.empty());
  RawlogObjects with_odometry = log_with("IMU");
  with_odometry.insert(with_odometry.begin(), odometry(kStart, {1, 0, 0}));
  EXPECT_FALSE(read(with_odometry).at(1).imu_heading_rad);
  LogOptions options;
  options.odometry = "none";
  expect_headings(read(with_odometry, options));

  RawlogObjects two = log_with("IMU");
  two.push_back(imu_rate(kStart + 2'000'000, 0, "CAMERA"));
  EXPECT_FALSE(read(two).at(1).imu_heading_rad);
  EXPECT_THAT(contents_.assumptions,
              testing::ElementsAre(testing::HasSubstr("the log has several: \"CAMERA\", \"IMU\"")));
  options.imu = "IMU";
  expect_headings(read(two, options));
  EXPECT_TRUE(contents_.assumptions.empty());
  options.imu = "GYRO";
  EXPECT_EQ(sentence_about(two, options),
            "log.imu is \"GYRO\", expected the label of a CObservationIMU with a rate of turn of " +
                path_.string() + ": \"CAMERA\", \"IMU\"");
  options.imu = "none";
  EXPECT_FALSE(read(two, options).at(1).imu_heading_rad);
}

TEST_F(RawlogReaderTest, an_imu_without_a_rate_of_turn_is_no_gyroscope) {
  const auto imu = imu_rate(kStart, 1);
  imu->dataIsPresent.fill(false);
  imu->set(mrpt::obs::IMU_YAW, 1);
  const auto frames = read({imu, range_scan(kStart), imu});
  EXPECT_FALSE(frames.at(0).imu_heading_rad);
  EXPECT_TRUE(contents_.assumptions.empty());
}

TEST_F(RawlogReaderTest, skips_odometry_that_is_not_finite) {
  const auto scan = sensory_frame({range_scan(kStart)});
  const auto frames =
      read({movement({1, 0, 0}), scan, movement({std::nan(""), 0, 0}), scan, movement({1, 0, 0}), scan});
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(frames[0].has_odometry);
  EXPECT_FALSE(frames[1].has_odometry) << "the motion before this scan is unknown";
  EXPECT_TRUE(frames[2].has_odometry);
  expect_pose(frames[2].odom_T_robot, {2, 0, 0});
  EXPECT_EQ(contents_.skipped.count, 1U);
  EXPECT_EQ(contents_.skipped.first,
            path_.string() + ": object 3: the odometry is not finite, or beyond 10,000 km");
}

TEST_F(RawlogReaderTest, reports_odometry_that_is_never_finite) {
  RawlogObjects objects;
  for (int i = 0; i < 3; ++i) {
    objects.push_back(odometry(kStart + i * 100'000, mrpt::poses::CPose2D(std::nan(""), 0, 0)));
    objects.push_back(range_scan(kStart + i * 100'000));
  }
  EXPECT_EQ(sentence_about(objects),
            path_.string() +
                ": object 1: the odometry is not finite, or beyond 10,000 km, as in all of its "
                "observations. Map without odometry with log.odometry=none");
  LogOptions options;
  options.odometry = "none";
  EXPECT_EQ(read(objects, options).size(), 3U);
}

TEST_F(RawlogReaderTest, reports_missing_scans_and_time_stamps) {
  EXPECT_EQ(
      sentence_about({movement({1, 0, 0}), sensory_frame({})}),
      path_.string() +
          " has no laser scans, expected observations of class CObservation2DRangeScan. Choose another log");
  const auto scan = range_scan(kStart);
  scan->timestamp = INVALID_TIMESTAMP;
  EXPECT_EQ(sentence_about({movement({1, 0, 0}), sensory_frame({scan})}),
            path_.string() +
                ": object 2: the scan has no time stamp, expected one on every observation. "
                "Record the log with time stamps");
}

TEST_F(RawlogReaderTest, skips_and_counts_invalid_scans) {
  const auto unstamped = range_scan(kStart + 1);
  unstamped->timestamp = INVALID_TIMESTAMP;
  const auto degrees = range_scan(kStart + 2);
  degrees->aperture = 180;
  const auto tilted = range_scan(kStart + 3);
  tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0.5, 0);
  for (const auto& [invalid, sentence] :
       {std::pair{unstamped, "the scan has no time stamp"}, std::pair{degrees, "expected at most two turns"},
        std::pair{tilted, "expected at most 15"}, std::pair{range_scan(kStart + 4, "LASER", {}), "0 rays"}}) {
    const auto frames =
        read({movement({1, 0, 0}), sensory_frame({invalid, range_scan(kStart + 5)}), movement({1, 0, 0}),
              sensory_frame({range_scan(kStart + 6), invalid}), sensory_frame({range_scan(kStart + 7)})});
    ASSERT_EQ(frames.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(frames[i].time_us, kStart + 5 + static_cast<TimeUs>(i));
    expect_pose(frames[1].odom_T_robot, {2, 0, 0});
    EXPECT_EQ(contents_.skipped.count, 2U);
    EXPECT_THAT(contents_.skipped.first, testing::HasSubstr(sentence));
    EXPECT_THAT(contents_.skipped.first, testing::HasSubstr(": object 2: "));
  }
}

TEST_F(RawlogReaderTest, yields_the_frames_before_the_end_of_a_truncated_file) {
  write_rawlog(
      path_, {movement({1, 0, 0}), sensory_frame({range_scan(kStart)}), sensory_frame({range_scan(kStart)})},
      false);
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  const auto reader = open_rawlog(path_, {});
  EXPECT_TRUE(reader->next());
  EXPECT_EQ(sentence_of([&] { reader->next(); }),
            path_.string() + ": object 3: the file ends within this object. Fetch the log again");
}

TEST(RawlogOfTelecomFaculty, yields_every_frame) {
  const std::filesystem::path path =
      "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path << " of Debian's mrpt-common";
  const auto frames = all_frames(*open_rawlog(path, {}));
  ASSERT_EQ(frames.size(), 225U) << "one frame for each of the 224 steps, and one at the start";
  EXPECT_EQ(frames[0].scan.ranges_m.size(), 361U);
  EXPECT_NEAR(frames[0].scan.bearings_rad->front(), -M_PI / 2, 1e-6);
  EXPECT_NEAR(frames[0].scan.robot_T_laser.x, 0.78, 1e-6);
  EXPECT_NEAR(seconds(frames.back().time_us - frames.front().time_us), 59, 1);
  EXPECT_EQ(frames[0].time_us, 1'137'834'225'713'386);
}

}  // namespace
}  // namespace psi_slam
