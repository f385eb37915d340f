// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// How much the motions between scans of one laser, by their alignment, differ from odometry.
struct OdometryDisagreement {
  double median_m = 0;          ///< metres at 2 m from the robot
  double standard_error_m = 0;  ///< of the median

  /// Returns whether it is less than another one by more than four standard errors of the difference.
  bool is_clearly_less_than(const OdometryDisagreement& other) const;
};

/// Compares the first 200 steps of about 0.1 m or 5 degrees. The median is infinite if fewer than 10 steps
/// can be aligned. Ends at the first error of the log.
OdometryDisagreement disagreement_with_odometry(FrameSource& scans);

}  // namespace psi_slam
