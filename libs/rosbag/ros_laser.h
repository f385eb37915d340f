// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "frames/laser_readings.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"
#include "rosbag/ros_messages.h"

namespace psi_slam {

/// Turns the scans of one topic into ours. The user's options override the messages. The number of beams and
/// the angles may differ between messages.
class RosLaser {
 public:
  explicit RosLaser(const LogOptions& options) : options_(options) {}

  /// `mount` is the laser's mount according to the transforms. A stated pose overrides its pose, but not
  /// whether it is upside down. Throws UserError that starts with `place` for invalid angles.
  LaserScan scan(RosLaserScan message, const FloorMount& mount, const std::string& place);

 private:
  struct Geometry {
    std::size_t beams = 0;
    float angle_min_rad = 0;
    float angle_increment_rad = 0;
    bool clockwise = false;
    bool operator==(const Geometry& other) const;
  };

  std::vector<float> bearings_rad(const Geometry& geometry) const;

  LogOptions options_;
  Geometry geometry_;  // of bearings_
  BeamBearings bearings_;
};

}  // namespace psi_slam
