// SPDX-License-Identifier: BSD-3-Clause
// Calibrates a log before it is mapped: scale of odometry, delay of scans and mount of the laser, from pairs
// of scans all over the log.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "doctor/pair_alignment.h"
#include "doctor/scan_delay.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

struct OdometryCalibration {
  /// Why nothing could be estimated, the second half of a sentence: "the log has no odometry". Empty after
  /// success.
  std::string obstacle;
  bool several_lasers = false;              ///< the estimates are those of the first laser
  double median_period_s = 0;               ///< time between scans
  mrpt::math::TPose2D stated_mount;         ///< pose of the laser as the log states it
  std::optional<ScanDelay> delay;           ///< empty: the scans show no delay of less than a second
  std::optional<LaserMountEstimate> mount;  ///< with the scale; empty: too few pairs of scans
};

/// Reads the log twice, or four times if the scans are stamped late, and estimates what odometry, as
/// corrected by `options`, still lacks. Thins no scans. A damaged log counts up to the damage. Throws
/// UserError if its first scan is unreadable.
OdometryCalibration calibrate_odometry(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
