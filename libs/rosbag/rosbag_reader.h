// SPDX-License-Identifier: BSD-3-Clause
// ROS bags of any kind (see bag_file.h): scans of sensor_msgs/LaserScan. Odometry of nav_msgs/Odometry, or of
// the transform odom -> base_link, is interpolated at the header stamp of each scan. The laser's mount comes
// from the transforms. A message without a stamp has the time at which it was recorded.
//
// A damaged or truncated bag yields all frames before that place. Odometry with an invalid pose is skipped.
#pragma once

#include <filesystem>
#include <memory>

#include "frames/log_reader.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a bag and reads until its topics and frames are known. Throws UserError if one is missing.
std::unique_ptr<LogReader> open_bag_log(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
