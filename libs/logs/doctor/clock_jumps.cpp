// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/clock_jumps.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr double kLeastStepBack_s = 1.0;
constexpr double kLeastJump_s = 5.0;
constexpr double kJumpPeriods = 20;
constexpr double kMoving_m = 0.02;  // least step of a moving robot
constexpr double kMetresPerRadian = 0.5;
constexpr double kMostChange = 2.0;  // of the speed of a moving robot from one step to the next
constexpr double kStandingShare = 0.01;

/// Length of the motion from the frame before, with turns, metres.
double step_m(const std::vector<FrameMark>& marks, std::size_t frame) {
  const mrpt::math::TPose2D motion = between(marks[frame - 1].odom_T_robot, marks[frame].odom_T_robot);
  return portable::hypot(motion.x, motion.y) + kMetresPerRadian * std::abs(mrpt::math::wrapToPi(motion.phi));
}

/// Returns whether the robot moved before and after `frame` as far as on the way to it.
bool moves_steadily(const std::vector<FrameMark>& marks, std::size_t frame) {
  if (frame < 2 || frame + 1 >= marks.size()) return false;
  const double before_m = step_m(marks, frame - 1);
  const double across_m = step_m(marks, frame);
  const double after_m = step_m(marks, frame + 1);
  const auto [least_m, most_m] = std::minmax({before_m, across_m, after_m});
  return least_m >= kMoving_m && most_m <= kMostChange * least_m;
}

/// Median deviation of values from their median, as a share of it.
double spread_of(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  return median(values) / middle;
}

/// Returns whether scans were taken at times, not after motions: some were taken while the robot stood, or
/// the periods are more alike than the steps. A log that is thinned by distance has equal steps and no scan
/// at rest, so a gap may be a pause.
bool is_sampled_in_time(const std::vector<FrameMark>& marks) {
  std::vector<double> steps_m;
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const double length_m = step_m(marks, i);
    if (length_m < kMoving_m) continue;
    steps_m.push_back(length_m);
    periods_s.push_back(std::abs(seconds(marks[i].time_us - marks[i - 1].time_us)));
  }
  const auto steps = static_cast<double>(marks.size()) - 1;
  const double standing = steps - static_cast<double>(steps_m.size());
  return steps_m.empty() || standing >= kStandingShare * steps || spread_of(periods_s) <= spread_of(steps_m);
}

}  // namespace

std::vector<ClockJump> clock_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                   bool has_odometry) {
  const double least_jump_s = std::max(kLeastJump_s, kJumpPeriods * median_period_s);
  std::vector<ClockJump> jumps;
  const bool tells_pauses = has_odometry && is_sampled_in_time(marks);
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const double passed_s = seconds(marks[i].time_us - marks[i - 1].time_us);
    const bool jumps_ahead = tells_pauses && passed_s > least_jump_s && moves_steadily(marks, i);
    if (passed_s < -kLeastStepBack_s || jumps_ahead) jumps.push_back({i, passed_s});
  }
  return jumps;
}

}  // namespace psi_slam
