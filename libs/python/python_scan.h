// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// The class psi_slam.Scan: a scan as a program states it.
struct PythonScan {
  TimeUs time_us = 0;
  LaserScan scan;  ///< with the ranges as stated; limit_ranges() has not been applied
  double min_range_m = 0;
  double max_range_m = 0;
};

/// Returns the frame of a scan. `odometry` is None or (x, y, yaw) of the robot in metres and radians. Throws
/// UserError for odometry that is not three finite numbers.
Frame frame_of(const PythonScan& scan, const pybind11::object& odometry, const LogOptions& options);

/// Adds the class Scan.
void bind_scan(pybind11::module_& module);

}  // namespace psi_slam
