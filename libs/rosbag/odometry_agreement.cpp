// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/odometry_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "frames/pose_operations.h"
#include "frames/scan_alignment.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kStep_m = 0.1;
constexpr double kStep_rad = 5 * M_PI / 180;
constexpr double kLever_m = 2;
constexpr std::size_t kMostSteps = 200;
constexpr std::size_t kLeastSteps = 10;
constexpr double kErrors = 4;  // least difference of two medians, in standard errors

std::optional<Frame> next_readable(FrameSource& scans) {
  try {
    return scans.next();
  } catch (const UserError&) {
    return std::nullopt;
  }
}

}  // namespace

bool OdometryDisagreement::is_clearly_less_than(const OdometryDisagreement& other) const {
  return other.median_m - median_m > kErrors * std::hypot(standard_error_m, other.standard_error_m);
}

OdometryDisagreement disagreement_with_odometry(FrameSource& scans) {
  std::vector<double> differences_m;
  std::optional<Frame> reference;
  while (differences_m.size() < kMostSteps) {
    std::optional<Frame> frame = next_readable(scans);
    if (!frame || !frame->has_odometry) break;
    if (reference) {
      const mrpt::math::TPose2D motion = between(reference->odom_T_robot, frame->odom_T_robot);
      if (motion.norm() < kStep_m && std::abs(motion.phi) < kStep_rad) continue;
      const ScanAlignment alignment =
          align_scans(AlignableScan(reference->scan), AlignableScan(frame->scan), motion);
      const mrpt::math::TPose2D off = between(motion, alignment.reference_T_scan);
      if (alignment.is_reliable()) differences_m.push_back(off.norm() + kLever_m * std::abs(off.phi));
    }
    reference = std::move(frame);
  }
  if (differences_m.size() < kLeastSteps) return {std::numeric_limits<double>::infinity(), 0};
  std::sort(differences_m.begin(), differences_m.end());
  // The rank of the true median has a standard error of half the root of the number of values.
  const std::size_t middle = differences_m.size() / 2;
  const auto ranks = static_cast<std::size_t>(std::sqrt(static_cast<double>(differences_m.size())) / 2);
  return {differences_m[middle], (differences_m[middle + ranks] - differences_m[middle - ranks]) / 2};
}

}  // namespace psi_slam
