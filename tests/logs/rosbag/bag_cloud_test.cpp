// SPDX-License-Identifier: BSD-3-Clause
// Point clouds in ROS bags, mapped as slices between two heights.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "bag_files.h"
#include "log_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Path = std::filesystem::path;

constexpr TimeUs kStart_us = 1'600'000'000'000'000;

/// Cloud of six points: a wall 2 m ahead of the sensor in two heights, a nearer point on the floor and one
/// above the robot, a point on the left, and an invalid point. The sensor is 0.4 m above the floor.
RecordedCloud small_cloud(TimeUs time_us = kStart_us) {
  RecordedCloud cloud;
  cloud.time_us = time_us;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  cloud.points = {{2, 0, 0.1}, {2.5, 0, -0.1}, {1, 0, -0.4}, {1, 0, 1.5}, {0, 3, 0.2}, {nan, nan, nan}};
  return cloud;
}

LogOptions with_slice() {
  LogOptions options;
  options.slice_z_m = "0.1 1.0";
  return options;
}

RecordedPose mount_of_lidar() {
  return static_mount("lidar", {0.2, 0, 0.4, 0, 0, 0});
}

class BagCloudTest : public testing::Test {
 protected:
  std::vector<Frame> read(const Recording& recording, const LogOptions& options = with_slice()) {
    write_mcap(path_, recording);
    const auto source = open_log(path_, options);
    auto frames = all_frames(*source);
    assumptions_ = source->assumptions();
    return frames;
  }

  std::string sentence_about(const Recording& recording, const LogOptions& options = {}) {
    return sentence_of([&] { read(recording, options); });
  }

  static void expect_small_cloud(const std::vector<Frame>& frames, const TPose2D& mount = {0.2, 0, 0}) {
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].time_us, kStart_us);
    const LaserScan& scan = frames[0].scan;
    EXPECT_EQ(scan.robot_T_laser, mount);
    std::vector<std::pair<double, double>> returns;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      EXPECT_FALSE(std::isinf(scan.ranges_m[i]));
      if (std::isfinite(scan.ranges_m[i]))
        returns.emplace_back(static_cast<double>((*scan.bearings_rad)[i]),
                             static_cast<double>(scan.ranges_m[i]));
    }
    ASSERT_EQ(returns.size(), 2U);
    EXPECT_NEAR(returns[0].first, 0, 1e-6);
    EXPECT_NEAR(returns[0].second, 2, 1e-6);
    EXPECT_NEAR(returns[1].first, M_PI / 2, 1e-6);
    EXPECT_NEAR(returns[1].second, 3, 1e-6);
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run.mcap";
  std::vector<std::string> assumptions_;
};

TEST_F(BagCloudTest, a_slice_is_a_scan_in_every_encoding) {
  for (const bool doubles : {false, true}) {
    for (const bool big_endian : {false, true}) {
      for (const std::uint32_t rows : {1U, 2U, 3U}) {
        RecordedCloud cloud = small_cloud();
        cloud.doubles = doubles;
        cloud.big_endian = big_endian;
        cloud.rows = rows;
        const Recording recording{mount_of_lidar(), cloud};
        expect_small_cloud(read(recording));
        EXPECT_THAT(assumptions_, IsEmpty());
        write_mcap(path_, recording, {"", 7, true, false});
        expect_small_cloud(frames_of(path_, with_slice()));
        write_ros1_bag(path_, recording);
        expect_small_cloud(frames_of(path_, with_slice()));
      }
    }
  }
}

TEST_F(BagCloudTest, clouds_have_the_odometry_of_their_time) {
  const auto odometry = [](TimeUs time_us, double x) {
    return RecordedPose{"/odom", time_us, "odom", "base_link", {x, 0, 0, 0, 0, 0}};
  };
  const auto frames = read(
      {mount_of_lidar(), odometry(kStart_us - 10'000, 1), small_cloud(), odometry(kStart_us + 10'000, 3)});
  expect_small_cloud(frames);
  EXPECT_NEAR(frames[0].odom_T_robot.x, 2, 1e-9);
}

TEST_F(BagCloudTest, without_a_mount_heights_are_measured_from_the_sensor) {
  RecordedCloud cloud = small_cloud();
  for (auto& point : cloud.points) point[2] += 0.4;
  expect_small_cloud(read({cloud}), {0, 0, 0});
  EXPECT_THAT(assumptions_,
              ElementsAre("the heights of log.slice_z_m are measured from the sensor of /points, "
                          "because no transform leads from the robot's frame to \"lidar\". "
                          "Subtract the sensor's height above the floor from log.slice_z_m, or "
                          "name the robot's frame with log.base_frame"));
  const RecordedPose odometry{"/odom", kStart_us, "odom", "base_link", {}};
  expect_small_cloud(read({odometry, cloud}), {0, 0, 0});
  EXPECT_THAT(assumptions_, ElementsAre(HasSubstr("the laser of /points is assumed at the robot's centre"),
                                        HasSubstr("are measured from the sensor of /points")));
  LogOptions options = with_slice();
  options.robot_T_laser = TPose2D(0.2, 0, 0);
  expect_small_cloud(read({odometry, cloud}, options));
  EXPECT_THAT(assumptions_, ElementsAre(HasSubstr("are measured from the sensor of /points")));
}

TEST_F(BagCloudTest, a_slice_replaces_laser_scans_unless_their_topic_is_named) {
  RecordedScan scan;
  scan.time_us = kStart_us + 500'000;
  const Recording recording{static_mount(), mount_of_lidar(), scan, small_cloud()};
  expect_small_cloud(read(recording));
  LogOptions options = with_slice();
  options.scan_topic = "all";
  expect_small_cloud(read(recording, options));
  options.scan_topic = "/points,/scan";
  EXPECT_EQ(read(recording, options).size(), 2U);
  options.scan_topic = "/scan";
  EXPECT_EQ(read(recording, options).at(0).scan.ranges_m.size(), 5U);
  options.slice_z_m.clear();
  EXPECT_EQ(read(recording, options).at(0).scan.ranges_m.size(), 5U);
  options.scan_topic.clear();
  EXPECT_EQ(read(recording, options).size(), 1U) << "without a slice, clouds are not read";
}

TEST_F(BagCloudTest, bags_and_topics_of_clouds_need_a_slice) {
  const Recording clouds{mount_of_lidar(), small_cloud()};
  EXPECT_EQ(sentence_about(clouds),
            path_.string() +
                " has no laser scans, but point clouds on /points. Map a slice of them with log.slice_z_m, "
                "such as \"0.1 1.0\" (heights above the floor in metres)");
  Recording both = clouds;
  both.emplace_back(RecordedScan{});
  LogOptions options;
  options.scan_topic = "points";
  EXPECT_EQ(sentence_about(both, options),
            "log.scan_topic names the point clouds on points of " + path_.string() +
                ". Map a slice of them with log.slice_z_m, such as \"0.1 1.0\" (heights above the floor in "
                "metres)");
}

TEST_F(BagCloudTest, reports_a_slice_without_clouds) {
  EXPECT_EQ(sentence_about({static_mount(), RecordedScan{}}, with_slice()),
            path_.string() +
                " has no point clouds, expected a topic of type sensor_msgs/PointCloud2; found /tf_static "
                "(tf2_msgs/TFMessage), /scan (sensor_msgs/LaserScan). Map laser scans with an empty "
                "log.slice_z_m");
  write_carmen(path_, recorded_run());
  EXPECT_EQ(sentence_of([&] { frames_of(path_, with_slice()); }),
            "log.slice_z_m is \"0.1 1.0\", expected an empty text for " + path_.string() +
                ", because CARMEN logs hold no point clouds");
}

TEST_F(BagCloudTest, an_empty_cloud_is_a_scan_without_a_reading) {
  RecordedCloud empty;
  empty.time_us = kStart_us;
  const auto frames = read({mount_of_lidar(), empty});
  ASSERT_EQ(frames.size(), 1U);
  for (const float range_m : frames[0].scan.ranges_m) EXPECT_TRUE(std::isnan(range_m));
}

/// Replaces the first occurrence of `from` in the bag's only cloud and returns the error message.
class DamagedCloudTest : public BagCloudTest {
 protected:
  std::string sentence_after(const std::string& from, const std::string& to) {
    write_ros1_bag(path_, {mount_of_lidar(), small_cloud()});
    std::string bytes = read_file(path_);
    const std::size_t place = bytes.find(from);
    EXPECT_NE(place, std::string::npos);
    write_file(path_, bytes.replace(place, from.size(), to));
    return sentence_of([&] { frames_of(path_, with_slice()); });
  }

  static std::string field(const char* name, std::uint32_t offset, std::uint8_t type) {
    return ros1_text(name) + ros1_packed(offset) + ros1_packed(type);
  }
};

TEST_F(DamagedCloudTest, is_reported) {
  EXPECT_THAT(sentence_after(field("x", 8, 7), field("x", 8, 5)),
              HasSubstr("the message on /points is damaged: the field x of its points has type 5, expected 7 "
                        "(float32) or 8 (float64)"));
  EXPECT_THAT(sentence_after(field("y", 12, 7), field("y", 14, 7)),
              HasSubstr("the field y extends beyond its points, which have 17 bytes"));
  EXPECT_THAT(sentence_after(field("z", 4, 7), field("Z", 4, 7)), HasSubstr("its points have no field z"));
  const std::string rows_and_columns = ros1_packed(std::uint32_t{1}) + ros1_packed(std::uint32_t{6});
  for (const std::uint32_t rows : {2U, 4'000'000'000U})
    EXPECT_THAT(sentence_after(rows_and_columns, ros1_packed(rows) + ros1_packed(std::uint32_t{6})),
                HasSubstr(std::to_string(rows) + " rows of 6 points, but has only 104 bytes"));
  EXPECT_THAT(sentence_after(rows_and_columns,
                             ros1_packed(std::uint32_t{1}) + ros1_packed(std::uint32_t{4'000'000'000U})),
              HasSubstr("1 rows of 4000000000 points"));
}

}  // namespace
}  // namespace psi_slam
