// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/odometry_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/portable_math.h"
#include "base/significance.h"
#include "logs/frames/aligned_steps.h"

namespace psi_slam {
namespace {

constexpr double kStep_m = 0.1;
constexpr double kStep_rad = 5 * M_PI / 180;
constexpr double kLever_m = 2;
constexpr std::size_t kMostSteps = 200;
constexpr std::size_t kLeastSteps = 10;

}  // namespace

bool OdometryDisagreement::is_clearly_less_than(const OdometryDisagreement& other) const {
  return other.median_m - median_m >
         kSignificantDeviations * portable::hypot(standard_error_m, other.standard_error_m);
}

OdometryDisagreement disagreement_with_odometry(FrameSource& scans) {
  std::vector<double> differences_m;
  AlignedSteps steps(scans, kStep_m, kStep_rad);
  while (differences_m.size() < kMostSteps) {
    const std::optional<AlignedStep> step = steps.next();
    if (!step) break;
    const mrpt::math::TPose2D off = step->difference();
    if (step->by_scans.is_reliable()) differences_m.push_back(off.norm() + kLever_m * std::abs(off.phi));
  }
  if (differences_m.size() < kLeastSteps) return {std::numeric_limits<double>::infinity(), 0};
  std::sort(differences_m.begin(), differences_m.end());
  // The rank of the true median has a standard error of half the root of the number of values.
  const std::size_t middle = differences_m.size() / 2;
  const auto ranks = static_cast<std::size_t>(std::sqrt(static_cast<double>(differences_m.size())) / 2);
  return {differences_m[middle], (differences_m[middle + ranks] - differences_m[middle - ranks]) / 2};
}

}  // namespace psi_slam
