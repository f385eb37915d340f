// SPDX-License-Identifier: BSD-3-Clause
// Feeds scans one by one to the mapper, as a driver on a robot does, and draws the map at the end.
//
//     02_feed_scans_one_by_one RAWLOG MAP.png
//
// A rawlog of MRPT with pairs of odometry and scan replaces the robot. The program needs only the component
// `mapping` of psi-slam. It prints x [m], y [m] and heading [rad] of the robot after each scan.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <psi_slam/configuration.h>
#include <psi_slam/grid_map.h>
#include <psi_slam/mapper.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <vector>

namespace {

/// Bearings of a scan's beams: equally spaced over the aperture, from right to left.
psi_slam::BeamBearings bearings_of(const mrpt::obs::CObservation2DRangeScan& observed) {
  const std::size_t beams = observed.getScanSize();
  std::vector<float> bearings_rad(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float from_right =
        observed.aperture * (static_cast<float>(i) / static_cast<float>(beams - 1) - 0.5F);
    bearings_rad[i] = observed.rightToLeft ? from_right : -from_right;
  }
  return std::make_shared<const std::vector<float>>(std::move(bearings_rad));
}

psi_slam::Frame frame_of(const mrpt::obs::CObservation2DRangeScan& observed,
                         const mrpt::math::TPose2D& odom_T_robot, std::size_t index) {
  psi_slam::Frame frame;
  frame.index = index;
  frame.time_us = std::llround(mrpt::Clock::toDouble(observed.timestamp) * 1e6);
  frame.odom_T_robot = odom_T_robot;
  frame.scan.bearings_rad = bearings_of(observed);
  frame.scan.max_range_m = observed.maxRange;
  frame.scan.robot_T_laser = mrpt::math::TPose2D(observed.sensorPose.asTPose());
  for (std::size_t i = 0; i < observed.getScanSize(); ++i)  // invalid ranges become NaN
    frame.scan.ranges_m.push_back(observed.getScanRangeValidity(i) ? observed.getScanRange(i)
                                                                   : std::numeric_limits<float>::quiet_NaN());
  return frame;
}

void map_rawlog(const std::string& rawlog, const std::string& picture) {
  mrpt::io::CFileGZInputStream file;
  if (!file.open(rawlog)) throw std::runtime_error("cannot open " + rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr actions;
  mrpt::obs::CSensoryFrame::Ptr observations;

  const psi_slam::Configuration configuration;  // every option has its default
  psi_slam::Mapper mapper(configuration);
  mrpt::math::TPose2D odom_T_robot;
  for (std::size_t i = 0; mrpt::obs::CRawlog::readActionObservationPair(archive, actions, observations, i);) {
    if (const auto moved = actions->getBestMovementEstimation())
      odom_T_robot = odom_T_robot + moved->poseChange->getMeanVal().asTPose();
    const auto observed = observations->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
    if (!observed) continue;
    mapper.add(frame_of(*observed, odom_T_robot, mapper.log().size()));
    const mrpt::math::TPose2D map_T_robot = mapper.map_T_robot();
    std::cout << map_T_robot.x << ' ' << map_T_robot.y << ' ' << map_T_robot.phi << '\n';
  }

  mapper.end_log();
  const psi_slam::MappingResult result = mapper.finish();  // final loop search and refinement
  std::vector<mrpt::math::TPose2D> map_T_robot;
  for (const psi_slam::FrameRecord& record : result.frames) map_T_robot.push_back(record.map_T_robot);
  psi_slam::draw_grid_map(result.log, map_T_robot, configuration)->saveAsBitmapFile(picture);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: 02_feed_scans_one_by_one RAWLOG MAP.png\n";
    return 2;
  }
  try {
    map_rawlog(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "02_feed_scans_one_by_one: " << error.what() << '\n';
    return 1;
  }
}
