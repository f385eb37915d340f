// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/sweep_motion.h"

#include <cmath>

#include "logs/frames/deskewed_source.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kMaxDuration_s = 1.0;
// Largest ratio of the sweep time to the duration. A larger sweep time is wrong.
constexpr double kMaxSweepRatio = 1.5;

bool straighten(LaserScan& scan, const TPose2D& motion, double duration_s) {
  const auto during_sweep = motion_during_sweep(motion, duration_s, static_cast<double>(scan.sweep_time_s));
  if (!during_sweep || scan.ranges_m.size() < 2) return false;
  scan = deskewed(scan, *during_sweep);
  return true;
}

}  // namespace

std::optional<TPose2D> motion_during_sweep(const TPose2D& motion, double duration_s, double sweep_s) {
  const double time_s = std::abs(sweep_s);
  if (!(time_s > 0) || !(duration_s > 0) || duration_s > kMaxDuration_s ||
      time_s > kMaxSweepRatio * duration_s)
    return std::nullopt;
  return interpolate({0, 0, 0}, motion, time_s / duration_s);
}

bool straighten(Frame& frame, const TPose2D& motion, double duration_s) {
  bool straightened = straighten(frame.scan, motion, duration_s);
  for (CompanionScan& companion : frame.companions)
    straightened = straighten(companion.scan, motion, duration_s) || straightened;
  return straightened;
}

}  // namespace psi_slam
