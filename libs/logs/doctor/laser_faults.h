// SPDX-License-Identifier: BSD-3-Clause
// Finds wrong statements of a log about its laser that make every map wrong: a field of view that is twice or
// half as large, and a heading on the robot that is far off.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "base/share_observer.h"
#include "logs/doctor/pair_alignment.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Wrong statements of a log about its laser, and what the scans show instead.
struct LaserFaults {
  double stated_field_of_view_rad = 0;
  std::size_t assumed_for_beams = 0;        ///< number of beams for which it is assumed; 0: the log states it
  std::optional<double> field_of_view_rad;  ///< set if the stated one is wrong; see FieldOfViewStudy
  mrpt::math::TPose2D stated_mount;
  std::optional<LaserMountEstimate> mount;  ///< set if the stated heading is wrong; see pair_calibration.h
};

/// Looks for wrong statements about the single laser of a log. Aligns pairs of scans from the beginning until
/// 30 have moved straight and 30 have turned, at most 400. Only if most of a kind contradict odometry,
/// diagnoses the whole log. Finds nothing in a log of several lasers or without odometry, and nothing that
/// `options` state. Finds nothing in an unreadable log.
LaserFaults find_laser_faults(const std::filesystem::path& path, const LogOptions& options,
                              const ShareObserver& progress = {});

}  // namespace psi_slam
