// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory/pose_at_time.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <iterator>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr TimeUs kSameTimeUs = 100;  // exclusive

TPose2D between(const StampedPose& before, const StampedPose& after, TimeUs time_us) {
  const double u =
      static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us);
  const TPose2D& a = before.pose;
  const TPose2D& b = after.pose;
  return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y),
          mrpt::math::wrapToPi(a.phi + u * mrpt::math::wrapToPi(b.phi - a.phi))};
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
