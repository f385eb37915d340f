// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose3D.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "frames/laser_choice.h"
#include "psi_slam/log_options.h"
#include "observations/rawlog_laser.h"

namespace psi_slam {

/// The lasers among MRPT's observations that are read, by their sensor labels.
class RawlogLasers {
 public:
  explicit RawlogLasers(const LogOptions& options);

  /// None when the laser is not read. Throws UserError, beginning with `place`, as RawlogLaser does, and when
  /// two lasers have the very same pose: then nobody has set it.
  std::optional<LaserScan> scan(const mrpt::obs::CObservation2DRangeScan& observation,
                                const std::string& place);

 private:
  struct Laser {
    std::string label;
    RawlogLaser reader;
    mrpt::poses::CPose3D robot_T_sensor;  // of its first scan
    bool is_stated = false;               // its mount, by the user
  };

  Laser& laser(std::size_t number, const mrpt::obs::CObservation2DRangeScan& first, const std::string& place);

  LogOptions options_;
  ChosenLasers chosen_;
  std::map<std::size_t, Laser> lasers_;
};

}  // namespace psi_slam
