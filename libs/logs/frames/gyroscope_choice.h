// SPDX-License-Identifier: BSD-3-Clause
// Selects the gyroscope that predicts the heading of scans without odometry.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "psi_slam/log_options.h"

namespace psi_slam {

/// Returns whether the user wants no gyroscope.
bool ignores_gyroscope(const LogOptions& options);

/// Returns whether the user names the gyroscope.
bool names_gyroscope(const LogOptions& options);

struct GyroscopeChoice {
  std::optional<std::string> name;  ///< topic or sensor label; empty: no gyroscope is used
  std::string assumption;           ///< see FrameSource::assumptions(); empty: nothing is assumed
};

/// Chooses one of the gyroscopes of a log by `options.imu`. A log with odometry needs none. "auto" chooses
/// the only gyroscope. Throws UserError if the named gyroscope is missing. `expected` describes a gyroscope
/// of the log for the error message: "a topic of type sensor_msgs/Imu of run.bag".
GyroscopeChoice choose_gyroscope(const LogOptions& options, const std::vector<std::string>& gyroscopes,
                                 bool has_odometry, const std::string& expected);

}  // namespace psi_slam
