// SPDX-License-Identifier: BSD-3-Clause
// Compares the motions of a log by odometry with those by the alignment of its scans, step by step.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "logs/frames/scan_alignment.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Motion between two scans.
struct AlignedStep {
  mrpt::math::TPose2D by_odometry;
  ScanAlignment by_scans;             ///< aligned with odometry's motion as the guess
  mrpt::math::TPose2D robot_T_laser;  ///< of the first of both scans

  /// Pose by the scans relative to the pose by odometry.
  mrpt::math::TPose2D difference() const;
};

/// Steps of a log of one laser. Each is the shortest that odometry moves by `distance_m` or `turn_rad`, and
/// begins where the step before it ends.
class AlignedSteps {
 public:
  AlignedSteps(FrameSource& scans, double distance_m, double turn_rad)
      : scans_(scans), distance_m_(distance_m), turn_rad_(turn_rad) {}

  /// Returns the next step. Empty at the end of the log, at its first error and at a scan without odometry.
  std::optional<AlignedStep> next();

 private:
  std::optional<Frame> next_frame();

  FrameSource& scans_;
  double distance_m_;
  double turn_rad_;
  std::optional<Frame> reference_;
};

}  // namespace psi_slam
