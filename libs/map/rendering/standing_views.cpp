// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/standing_views.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "base/degrees.h"
#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_tolerance.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kLeastFrames = 50;
constexpr double kLeast_s = 10;
constexpr double kMaxStep_s = 5;
constexpr PoseTolerance kPlace{0.02, radians_from_degrees(0.5L)};
constexpr std::size_t kMostViews = 64;
constexpr std::size_t kFewestFarther = 8;  // one in so many views must see farther
constexpr double kLeastFarther_m = 0.3;
constexpr double kLeastFartherShare = 0.05;

/// Makes the readings of one laser invalid where enough of its other scans see farther. The scans have
/// equally many beams, and neither the robot nor the beams move.
void remove_visitors(const std::vector<LaserScan*>& scans) {
  for (std::size_t beam = 0; beam < scans.front()->ranges_m.size(); ++beam) {
    std::vector<float> ranges_m;
    for (const LaserScan* scan : scans)
      if (std::isfinite(scan->ranges_m[beam])) ranges_m.push_back(scan->ranges_m[beam]);
    if (ranges_m.empty()) continue;
    const auto farther = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / kFewestFarther);
    std::nth_element(ranges_m.begin(), farther, ranges_m.end(), std::greater<>());
    const auto far_m = static_cast<double>(*farther);
    const double near_m = far_m - std::max(kLeastFarther_m, kLeastFartherShare * far_m);
    for (LaserScan* scan : scans)
      if (static_cast<double>(scan->ranges_m[beam]) < near_m)
        scan->ranges_m[beam] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

std::vector<StandingSpan> standing_spans(const std::vector<Frame>& log,
                                         const std::vector<TPose2D>& map_T_robot) {
  std::vector<StandingSpan> spans;
  for (StandingSpan span; span.begin < log.size(); span.begin = span.end) {
    const auto goes_on = [&](std::size_t i) {
      const double step_s = seconds(log[i].time_us - log[i - 1].time_us);
      return step_s >= 0 && step_s <= kMaxStep_s &&
             is_same_place(map_T_robot[i], map_T_robot[span.begin], kPlace);
    };
    span.end = span.begin + 1;
    while (span.end < log.size() && goes_on(span.end)) ++span.end;
    const double length_s = seconds(log[span.end - 1].time_us - log[span.begin].time_us);
    if (span.end - span.begin >= kLeastFrames && length_s >= kLeast_s) spans.push_back(span);
  }
  return spans;
}

std::vector<StandingView> standing_views(const std::vector<Frame>& log, const StandingSpan& span) {
  const double start_s = seconds(log[span.begin].time_us);
  const double length_s = seconds(log[span.end - 1].time_us) - start_s;
  const std::size_t count = std::min(kMostViews, span.end - span.begin);
  std::vector<StandingView> views;
  std::size_t next = span.begin;
  std::size_t last_with_ranges = span.begin;
  for (std::size_t view = 0; view < count; ++view) {
    const double until_s =
        start_s + length_s * (static_cast<double>(view) + 0.5) / static_cast<double>(count);
    for (; next < span.end && seconds(log[next].time_us) <= until_s; ++next)
      if (has_ranges(log[next])) last_with_ranges = next;
    views.push_back({log[last_with_ranges], last_with_ranges});
  }
  std::map<std::pair<std::size_t, std::size_t>, std::vector<LaserScan*>> scans;
  const auto add = [&](LaserScan& scan) { scans[{scan.laser, scan.ranges_m.size()}].push_back(&scan); };
  for (StandingView& view : views) {
    add(view.frame.scan);
    for (CompanionScan& companion : view.frame.companions) add(companion.scan);
  }
  for (const auto& [laser_and_beams, of_laser] : scans) remove_visitors(of_laser);
  return views;
}

}  // namespace psi_slam
