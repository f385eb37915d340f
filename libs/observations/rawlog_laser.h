// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cstddef>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Turns the 2D range scans of an MRPT rawlog into ours. The pose of the sensor is projected to the floor; a
/// laser mounted upside down has its bearings turned round for that.
class RawlogLaser {
 public:
  explicit RawlogLaser(const LogOptions& options) : options_(options) {}

  /// Throws UserError, beginning with `place`, when the scan has no rays or its laser is tilted by more than
  /// 15 degrees.
  LaserScan scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place);

 private:
  std::vector<float> bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const;

  LogOptions options_;
  std::size_t beams_ = 0;  // these three: what bearings_ was made for
  double aperture_rad_ = 0;
  bool clockwise_ = false;
  BeamBearings bearings_;
};

}  // namespace psi_slam
