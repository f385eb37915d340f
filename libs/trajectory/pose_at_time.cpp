// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory/pose_at_time.h"

#include <algorithm>
#include <iterator>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr TimeUs kSameTimeUs = 100;  // exclusive

mrpt::math::TPose2D between(const StampedPose& before, const StampedPose& after, TimeUs time_us) {
  const double u =
      static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us);
  return interpolate(before.pose, after.pose, u);
}

}  // namespace

std::optional<PoseAtTime> pose_at_time(const Trajectory& sorted, TimeUs time_us, TimeUs max_gap_us) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), time_us,
                       [](const StampedPose& pose, TimeUs time) { return pose.time_us < time; });
  const auto at = static_cast<std::size_t>(after - sorted.begin());
  if (after != sorted.begin() && time_us - std::prev(after)->time_us < kSameTimeUs)
    return PoseAtTime{std::prev(after)->pose, false, at - 1};
  if (after != sorted.end() && after->time_us - time_us < kSameTimeUs)
    return PoseAtTime{after->pose, false, at};
  if (after == sorted.begin() || after == sorted.end()) return std::nullopt;
  if (after->time_us - std::prev(after)->time_us > max_gap_us) return std::nullopt;
  return PoseAtTime{between(*std::prev(after), *after, time_us), true, at - 1};
}

}  // namespace psi_slam
