// SPDX-License-Identifier: BSD-3-Clause
#include "frames/straightened_frame.h"

#include <cmath>

#include "frames/deskewed_source.h"
#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kMaxDuration_s = 1.0;
constexpr double kMaxSweepRatio = 1.5;

bool straighten(LaserScan& scan, const TPose2D& motion, double duration_s) {
  const double sweep_s = std::abs(static_cast<double>(scan.sweep_time_s));
  if (!(sweep_s > 0) || scan.ranges_m.size() < 2 || sweep_s > kMaxSweepRatio * duration_s) return false;
  scan = deskewed(scan, interpolate({0, 0, 0}, motion, sweep_s / duration_s));
  return true;
}

}  // namespace

bool straighten(Frame& frame, const TPose2D& motion, double duration_s) {
  if (!(duration_s > 0) || duration_s > kMaxDuration_s) return false;
  bool straightened = straighten(frame.scan, motion, duration_s);
  for (CompanionScan& companion : frame.companions)
    straightened = straighten(companion.scan, motion, duration_s) || straightened;
  return straightened;
}

}  // namespace psi_slam
