// SPDX-License-Identifier: BSD-3-Clause
// Calibrates a log before it is mapped: scale of odometry, delay of scans and mount of the laser, from pairs
// of scans all over the log.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/share_observer.h"
#include "logs/doctor/pair_alignment.h"
#include "logs/doctor/scan_delay.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Delay of the scans of a laser.
struct LaserDelay {
  std::string laser;                 ///< name; see SingleLaser::name
  std::optional<ScanDelay> delay{};  ///< empty: the scans show no delay of less than a second
  std::string obstacle{};            ///< why nothing could be estimated; see OdometryCalibration
};

struct OdometryCalibration {
  /// Why nothing could be estimated, the second half of a sentence: "the log has no odometry". Empty after
  /// success.
  std::string obstacle;
  std::vector<LaserDelay> delays;           ///< of all lasers, or of the first if `options` state delays
  mrpt::math::TPose2D stated_mount;         ///< pose of the first laser as the log states it
  std::optional<LaserMountEstimate> mount;  ///< of the first laser, with the scale; empty: too few pairs
  bool several_lasers = false;
};

/// Reads the log twice for each laser, or four times if its swept scans are stamped late, and estimates what
/// odometry, as corrected by `options`, still lacks. Scale and mount come from the first laser. Thins no
/// scans. A damaged log counts up to the damage. Throws UserError if its first scan is unreadable. Calls
/// `progress` many times a second.
OdometryCalibration calibrate_odometry(const std::filesystem::path& path, const LogOptions& options,
                                       const ShareObserver& progress = {});

}  // namespace psi_slam
