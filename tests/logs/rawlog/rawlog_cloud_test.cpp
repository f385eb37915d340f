// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs of 3D sensors in a room with vertical walls: x = -3 m, x = 4 m, y = -2 m and y = 2.5 m in the frame
// of the robot. Every class of observations gives a scan whose beams end on these walls.
#include <gmock/gmock.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <cstring>

#include "base/compression/compressed_file.h"
#include "log_files.h"
#include "logs/rawlog/observation_stream.h"
#include "rawlog_files.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint3D;
using mrpt::obs::CObservation;
using mrpt::poses::CPose3D;

constexpr TimeUs kFirst_us = 1'464'602'099'833'205;
const CPose3D kMount(0.3, -0.1, 0.6, 0.4, 0, 0);  // of the sensor on the robot

/// Distance of the nearest wall from a point in the robot's frame, metres.
double distance_from_walls_m(double x, double y) {
  return std::min({std::abs(x + 3), std::abs(x - 4), std::abs(y + 2), std::abs(y - 2.5)});
}

/// Range to the walls in a direction of the sensor's frame, metres.
double range_m(double azimuth_rad, double elevation_rad) {
  const double heading = kMount.yaw() + azimuth_rad;
  const double dx = std::cos(heading) * std::cos(elevation_rad);
  const double dy = std::sin(heading) * std::cos(elevation_rad);
  return std::min(((dx > 0 ? 4 : -3) - kMount.x()) / dx, ((dy > 0 ? 2.5 : -2) - kMount.y()) / dy);
}

/// Points of the walls around the sensor, in its frame, from 0.2 m below to 0.3 m above it.
std::vector<TPoint3D> wall_points() {
  std::vector<TPoint3D> points;
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.01)
    for (const double z : {-0.2, 0.0, 0.3}) {
      const double range = range_m(azimuth, 0);
      points.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), z);
    }
  return points;
}

CObservation::Ptr point_cloud() {
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->pointcloud = mrpt::maps::CSimplePointsMap::Create();
  for (const TPoint3D& point : wall_points()) cloud->pointcloud->insertPoint(point);
  cloud->pointcloud->insertPoint(1, 0, -0.6F);  // floor
  cloud->pointcloud->insertPoint(1, 0, 1.5F);   // lamp
  return cloud;
}

CObservation::Ptr camera_with_points() {
  auto camera = mrpt::obs::CObservation3DRangeScan::Create();
  const auto points = wall_points();
  camera->hasPoints3D = true;
  camera->resizePoints3DVectors(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    camera->points3D_x[i] = static_cast<float>(points[i].x);
    camera->points3D_y[i] = static_cast<float>(points[i].y);
    camera->points3D_z[i] = static_cast<float>(points[i].z);
  }
  return camera;
}

/// A camera with 64 x 48 pixels.
CObservation::Ptr camera_with_ranges() {
  constexpr int kColumns = 64;
  constexpr int kRows = 48;
  constexpr double kFocus = 50;
  auto camera = mrpt::obs::CObservation3DRangeScan::Create();
  camera->cameraParams.ncols = kColumns;
  camera->cameraParams.nrows = kRows;
  camera->cameraParams.setIntrinsicParamsFromValues(kFocus, kFocus, kColumns / 2.0, kRows / 2.0);
  camera->hasRangeImage = true;
  camera->range_is_depth = true;
  camera->rangeUnits = 0.001F;
  camera->rangeImage_setSize(kRows, kColumns);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = std::atan2(kColumns / 2.0 - column, kFocus);
      const double depth_m = range_m(azimuth, 0) * std::cos(azimuth);
      camera->rangeImage(row, column) = static_cast<std::uint16_t>(std::lround(1000 * depth_m));
    }
  return camera;
}

/// A revolution of a VLP-16 in steps of 0.4 degrees. Its azimuths are clockwise.
mrpt::obs::CObservationVelodyneScan::Ptr velodyne() {
  constexpr int kPackets = 74;
  constexpr int kBlocks = 12;
  auto scan = mrpt::obs::CObservationVelodyneScan::Create();
  scan->calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("VLP16");
  for (int i = 0; i < kPackets; ++i) {
    std::string bytes;
    const auto add = [&](auto number) {
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    for (int block = 0; block < kBlocks; ++block) {
      const auto rotation = static_cast<std::uint16_t>((i * kBlocks + block) * 40);
      add(std::uint16_t{0xEEFF});
      add(rotation);
      for (std::size_t laser = 0; laser < 32; ++laser) {
        const double elevation_rad =
            scan->calibration.laser_corrections[laser % 16].verticalCorrection * M_PI / 180;
        // The second sequence of the 16 lasers is fired half a step later.
        const double azimuth_rad = -(rotation + (laser < 16 ? 0 : 20)) * 0.01 * M_PI / 180;
        add(static_cast<std::uint16_t>(std::lround(range_m(azimuth_rad, elevation_rad) / 0.002)));
        add(std::uint8_t{100});
      }
    }
    add(static_cast<std::uint32_t>(1000 + i * 1327));
    add(std::uint8_t{0x37});
    add(std::uint8_t{0x22});
    auto& packet = scan->scan_packets.emplace_back();
    std::memcpy(reinterpret_cast<char*>(&packet), bytes.data(), bytes.size());
  }
  return scan;
}

CObservation::Ptr rotating_planar() {
  mrpt::obs::CObservation2DRangeScan planar;
  planar.aperture = 4;
  planar.maxRange = 30;
  constexpr std::size_t kBeams = 401;
  planar.resizeScan(kBeams);
  for (std::size_t i = 0; i < kBeams; ++i) {
    planar.setScanRange(i, static_cast<float>(range_m(-2 + 0.01 * static_cast<double>(i), 0)));
    planar.setScanRangeValidity(i, true);
  }
  auto scan = mrpt::obs::CObservationRotatingScan::Create();
  scan->fromScan2D(planar);
  scan->minRange = 0;
  return scan;
}

struct Sensor {
  std::string name;
  CObservation::Ptr (*observe)();
  std::size_t least_beams = 0;
  friend void PrintTo(const Sensor& sensor, std::ostream* out) { *out << sensor.name; }
};

class RawlogCloud : public testing::TestWithParam<Sensor> {
 protected:
  static CObservation::Ptr observed(TimeUs time_us) {
    CObservation::Ptr observation = GetParam().observe();
    observation->timestamp = mrpt_time(time_us);
    observation->sensorLabel = "LIDAR";
    observation->setSensorPose(kMount);
    return observation;
  }

  static void check_slices(const std::vector<Frame>& frames) {
    ASSERT_EQ(frames.size(), 2U) << "the 2D scan is not read";
    EXPECT_EQ(frames[1].time_us, kFirst_us + 100'000);
    EXPECT_NEAR(frames[1].odom_T_robot.x, 2, 1e-9);
    const LaserScan& scan = frames[1].scan;
    EXPECT_NEAR(scan.robot_T_laser.phi, 0.4, 1e-6);
    std::size_t beams = 0;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      if (!std::isfinite(scan.ranges_m[i])) continue;
      ++beams;
      const double heading = scan.robot_T_laser.phi + static_cast<double>(scan.bearings_rad->at(i));
      const auto range = static_cast<double>(scan.ranges_m[i]);
      EXPECT_LT(distance_from_walls_m(scan.robot_T_laser.x + range * std::cos(heading),
                                      scan.robot_T_laser.y + range * std::sin(heading)),
                0.03)
          << "beam " << i;
    }
    EXPECT_GE(beams, GetParam().least_beams);
  }

  static LogOptions sliced() {
    LogOptions options;
    options.slice_z_m = "0.3 1.0";
    return options;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.rawlog";
};

/// Frames of a file, or of a recording that is read as it grows.
std::vector<Frame> frames_read(const std::filesystem::path& path, const LogOptions& options, bool is_live) {
  if (!is_live) return frames_of(path, options);
  return all_frames(*open_rawlog_stream(std::make_unique<CompressedFile>(path), options, 1));
}

TEST_P(RawlogCloud, is_sliced_at_heights_above_the_floor) {
  // The robot stands still: a moving one would not see the same points twice.
  write_rawlog(path_, {movement({2, 0, 0}), sensory_frame({observed(kFirst_us), range_scan(kFirst_us)}),
                       movement({0, 0, 0}), sensory_frame({observed(kFirst_us + 100'000)})});
  for (const bool is_live : {false, true}) check_slices(frames_read(path_, sliced(), is_live));
}

TEST(RawlogClouds, of_external_files_are_read_by_both_readers) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.rawlog";
  std::filesystem::create_directory(folder.path() / "log_Images");
  std::string bytes;
  for (const TPoint3D& point : wall_points())
    for (const double number : {point.x, point.y, point.z, 1.0}) {
      const auto value = static_cast<float>(number);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  write_file(folder.path() / "log_Images" / "cloud.bin", bytes);
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->setAsExternalStorage("cloud.bin",
                              mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  cloud->timestamp = mrpt_time(kFirst_us);
  cloud->sensorLabel = "LIDAR";
  write_rawlog(path, {movement({1, 0, 0}), sensory_frame({cloud})});
  LogOptions options;
  options.slice_z_m = "-0.3 1.0";
  for (const bool is_live : {true, false})  // this process must not know the folder beforehand
    EXPECT_EQ(frames_read(path, options, is_live).size(), 1U) << is_live;
}

TEST_P(RawlogCloud, without_laser_scans_asks_for_a_slice) {
  write_rawlog(path_, {sensory_frame({observed(kFirst_us)})});
  EXPECT_EQ(
      sentence_of([&] { open_log(path_); }),
      path_.string() +
          " has no laser scans, expected observations of class CObservation2DRangeScan. Map a slice of "
          "its point clouds with log.slice_z_m, such as \"0.1 1.0\" (heights above the floor in metres)");
}

INSTANTIATE_TEST_SUITE_P(Sensors, RawlogCloud,
                         testing::Values(Sensor{"point_cloud", &point_cloud, 600},
                                         Sensor{"camera_with_points", &camera_with_points, 600},
                                         Sensor{"camera_with_ranges", &camera_with_ranges, 60},
                                         Sensor{"velodyne", [] { return CObservation::Ptr(velodyne()); },
                                                600},
                                         Sensor{"rotating_planar", &rotating_planar, 350}),
                         [](const auto& tested) { return tested.param.name; });

TEST(RawlogClouds, that_cannot_be_read_are_skipped_and_counted) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.rawlog";
  auto unknown = mrpt::obs::CObservationRotatingScan::Create();
  unknown->rowCount = 7;
  unknown->timestamp = mrpt_time(kFirst_us);
  unknown->sensorLabel = "LIDAR";
  auto missing = mrpt::obs::CObservationPointCloud::Create();
  missing->setAsExternalStorage("nowhere.bin",
                                mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  missing->timestamp = mrpt_time(kFirst_us + 1);
  missing->sensorLabel = "LIDAR";
  auto cloud = point_cloud();
  cloud->timestamp = mrpt_time(kFirst_us + 2);
  cloud->sensorLabel = "LIDAR";
  write_rawlog(path, {movement({1, 0, 0}), sensory_frame({unknown}), sensory_frame({missing}),
                      sensory_frame({cloud})});
  LogOptions options;
  options.slice_z_m = "-0.3 1.0";
  const auto log = open_log(path, options);
  EXPECT_EQ(all_frames(*log).size(), 1U);
  EXPECT_EQ(log->skipped_lines().count, 2U);
  EXPECT_THAT(log->skipped_lines().first, testing::HasSubstr("has 7 rows"));
}

}  // namespace
}  // namespace psi_slam
