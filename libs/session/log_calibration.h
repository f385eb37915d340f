// SPDX-License-Identifier: BSD-3-Clause
// Decides what log.calibrate uses of the estimates that a log gives, and says so.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/share_observer.h"
#include "map/exports/run_summary.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

struct LaserFaults;
struct OdometryCalibration;

/// Estimates of a log.
struct LogCalibration {
  std::vector<CalibratedOption> estimates;
  std::vector<std::string> sentences;  ///< one for each estimate or obstacle, without full stop
};

/// Decides on the estimates of options that `options` leave open: the scale if its standard deviation is at
/// most 0.5 % and it is between 0.5 and 2; the mount of a single laser if those of its position and heading
/// are at most 2 cm and 0.5 degrees. Mount and delay must differ from what the log states by four standard
/// deviations, and the mount by 3 cm or 0.8 degrees.
LogCalibration use_calibration(const OdometryCalibration& calibration, const LogOptions& options);

/// Decides what replaces wrong statements of the log about its laser, and says so: a field of view; a mount
/// whose standard deviations are as small as use_calibration() requires.
LogCalibration use_laser_faults(const LaserFaults& faults);

/// Finds wrong statements about the laser, and with options.calibrate calibrates the log as `options` read
/// it. The progress is 0 until it calibrates. The estimates do not name the log. Throws UserError if the log
/// is unreadable.
LogCalibration calibrate_log(const std::filesystem::path& log, const LogOptions& options,
                             const ShareObserver& progress = {});

/// Returns the options with those estimates that are used; without options.calibrate, with those only that
/// replace wrong statements. An estimated mount selects the laser that it is for, unless log.laser does.
LogOptions calibrated_options(LogOptions options, const LogCalibration& calibration);

/// Marks the estimated mount as not used. Returns whether it was used.
bool unuse_mount(LogCalibration& calibration);

}  // namespace psi_slam
