// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "frames/floor_mount.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"
#include "rosbag/ros_messages.h"

namespace psi_slam {

/// Turns the scans of one topic of a ROS bag into ours: what the messages state, over that what the user
/// states. Every message may have another number of beams and other angles.
class RosLaser {
 public:
  explicit RosLaser(const LogOptions& options) : options_(options) {}

  /// `mount` is the laser's by the transforms; a stated pose stands over it, but whether it hangs upside down
  /// is the transforms' to say. Throws UserError, beginning with `place`, when the angles make no sense.
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
  Geometry geometry_;  // that of bearings_
  BeamBearings bearings_;
};

}  // namespace psi_slam
