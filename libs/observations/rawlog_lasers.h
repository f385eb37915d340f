// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "frames/laser_choice.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Turns MRPT's 2D range scans of one sensor into ours. The sensor's pose is projected to the floor. A laser
/// that is mounted upside down gets mirrored bearings.
class RawlogLaser {
 public:
  explicit RawlogLaser(const LogOptions& options) : options_(options) {}

  /// Throws UserError that starts with `place` if the scan has no rays or its laser is tilted by more than 15
  /// degrees.
  LaserScan scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place);

 private:
  std::vector<float> bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const;

  LogOptions options_;
  std::tuple<std::size_t, double, bool> geometry_;  // of bearings_: beams, aperture, clockwise
  BeamBearings bearings_;
};

/// Selects the lasers to read among MRPT's observations, by their sensor labels.
class RawlogLasers {
 public:
  explicit RawlogLasers(const LogOptions& options);

  /// Returns nothing if the laser is not read. Throws UserError that starts with `place` if RawlogLaser does,
  /// and if two lasers have the same pose: their poses were then never set.
  std::optional<LaserScan> scan(const mrpt::obs::CObservation2DRangeScan& observation,
                                const std::string& place);

 private:
  struct Laser {
    std::string label;
    RawlogLaser reader;
    mrpt::poses::CPose3D robot_T_sensor;  // of its first scan
    bool is_stated = false;               // the user states its mount
  };

  Laser& laser(std::size_t number, const mrpt::obs::CObservation2DRangeScan& first, const std::string& place);

  LogOptions options_;
  ChosenLasers chosen_;
  std::map<std::size_t, Laser> lasers_;
};

}  // namespace psi_slam
