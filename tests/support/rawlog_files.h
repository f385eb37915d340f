// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that create the objects of a rawlog and write them with MRPT.
#pragma once

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

using RawlogObjects = std::vector<mrpt::serialization::CSerializable::Ptr>;

inline mrpt::system::TTimeStamp mrpt_time(TimeUs time_us) {
  return mrpt::system::TTimeStamp(mrpt::Clock::duration(116'444'736'000'000'000 + time_us * 10));
}

inline mrpt::obs::CObservation2DRangeScan::Ptr range_scan(TimeUs time_us, const std::string& label = "LASER",
                                                          const std::vector<float>& ranges_m = {1, 2, 3, 4,
                                                                                                5}) {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->timestamp = mrpt_time(time_us);
  scan->sensorLabel = label;
  scan->aperture = 2.0F;
  scan->maxRange = 30;
  if (!ranges_m.empty())
    scan->loadFromVectors(ranges_m.size(), ranges_m.data(), std::vector<char>(ranges_m.size(), 1).data());
  return scan;
}

inline mrpt::obs::CObservationOdometry::Ptr odometry(TimeUs time_us, const mrpt::poses::CPose2D& pose) {
  auto observation = mrpt::obs::CObservationOdometry::Create();
  observation->timestamp = mrpt_time(time_us);
  observation->sensorLabel = "ODOMETRY";
  observation->odometry = pose;
  return observation;
}

/// Observation of an IMU that measures the rate of turn about its z axis.
inline mrpt::obs::CObservationIMU::Ptr imu_rate(TimeUs time_us, double rate_radps,
                                                const std::string& label = "IMU",
                                                const mrpt::poses::CPose3D& robot_T_imu = {}) {
  auto observation = mrpt::obs::CObservationIMU::Create();
  observation->timestamp = mrpt_time(time_us);
  observation->sensorLabel = label;
  observation->sensorPose = robot_T_imu;
  observation->set(mrpt::obs::IMU_WZ, rate_radps);
  return observation;
}

inline mrpt::obs::CSensoryFrame::Ptr sensory_frame(
    const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  auto frame = mrpt::obs::CSensoryFrame::Create();
  for (const auto& observation : observations) frame->insert(observation);
  return frame;
}

inline mrpt::obs::CActionCollection::Ptr movement(const mrpt::poses::CPose2D& increment) {
  mrpt::obs::CActionRobotMovement2D action;
  action.computeFromOdometry(increment, mrpt::obs::CActionRobotMovement2D::TMotionModelOptions());
  return mrpt::obs::CActionCollection::Create(action);
}

inline void write_rawlog(const std::filesystem::path& path, const RawlogObjects& objects,
                         bool gzipped = true) {
  const auto write = [&](auto&& file) {
    auto archive = mrpt::serialization::archiveFrom(file);
    for (const auto& object : objects) archive << *object;
  };
  if (gzipped) {
    write(mrpt::io::CFileGZOutputStream(path.string()));
  } else {
    write(mrpt::io::CFileOutputStream(path.string()));
  }
}

}  // namespace psi_slam
