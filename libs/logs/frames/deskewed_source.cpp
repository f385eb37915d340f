// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/deskewed_source.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/sweep_motion.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

}  // namespace

LaserScan deskewed(const LaserScan& scan, const TPose2D& motion) {
  LaserScan still = scan;
  still.sweep_time_s = 0;
  std::vector<float> bearings = *scan.bearings_rad;
  const TPose2D laser_T_robot = inverse(scan.robot_T_laser);
  const std::size_t last = bearings.size() - 1;
  const bool backward = scan.sweep_time_s < 0;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const std::size_t measured_before = backward ? last - i : i;
    if (measured_before == 0) continue;
    const TPose2D moved =
        interpolate({0, 0, 0}, motion, static_cast<double>(measured_before) / static_cast<double>(last));
    const TPose2D first_T_laser = compose(compose(laser_T_robot, moved), scan.robot_T_laser);
    const auto bearing = static_cast<double>(bearings[i]);
    double turned = first_T_laser.phi;
    if (const auto range = static_cast<double>(scan.ranges_m[i]); std::isfinite(range)) {
      const double x = first_T_laser.x + range * portable::cos(bearing + first_T_laser.phi);
      const double y = first_T_laser.y + range * portable::sin(bearing + first_T_laser.phi);
      still.ranges_m[i] = static_cast<float>(portable::hypot(x, y));
      // Wraps only the turn: bearings may exceed pi.
      turned = mrpt::math::wrapToPi(portable::atan2(y, x) - bearing);
    }
    bearings[i] = static_cast<float>(bearing + turned);
  }
  still.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings));
  return still;
}

double SweepTiming::sweep_time_s(const LaserScan& scan) const {
  const auto stated_s = static_cast<double>(scan.sweep_time_s);
  const double sweep_s = time_s ? std::copysign(*time_s, stated_s) : stated_s;
  const bool is_decided = direction == SweepDirection::kAuto && scan.laser < directions.size();
  switch (is_decided ? directions[scan.laser] : direction) {
    case SweepDirection::kForward:
      return std::abs(sweep_s);
    case SweepDirection::kBackward:
      return -std::abs(sweep_s);
    case SweepDirection::kAuto:
      break;
  }
  return sweep_s;
}

DeskewedSource::DeskewedSource(std::unique_ptr<FrameSource> source, SweepTiming timing)
    : source_(std::move(source)), timing_(std::move(timing)) {}

std::vector<std::string> DeskewedSource::assumptions() const {
  std::vector<std::string> all = source_->assumptions();
  all.insert(all.end(), timing_.assumptions.begin(), timing_.assumptions.end());
  return all;
}

std::optional<TPose2D> DeskewedSource::motion_between(const Mark& from, const Mark& to, double time_s) {
  if (!from.has_odometry || !to.has_odometry) return std::nullopt;
  return motion_during_sweep(between(from.odom_T_robot, to.odom_T_robot), seconds(to.time_us - from.time_us),
                             time_s);
}

DeskewedSource::Marks DeskewedSource::marks_of(const Frame& frame) {
  Marks marks{{frame.scan.laser, frame.time_us, frame.odom_T_robot, frame.has_odometry}};
  for (const CompanionScan& companion : frame.companions)
    marks.push_back({companion.scan.laser, companion.time_us,
                     compose(frame.odom_T_robot, companion.frame_T_robot), frame.has_odometry});
  return marks;
}

/// Returns the mark that has the same laser as `mark`, or else the first of `marks`.
const DeskewedSource::Mark& DeskewedSource::mark_like(const Mark& mark, const Marks& marks) {
  const auto same =
      std::find_if(marks.begin(), marks.end(), [&](const Mark& other) { return other.laser == mark.laser; });
  return same != marks.end() ? *same : marks.front();
}

void DeskewedSource::straighten(LaserScan& scan, const Mark& mark, const Marks& next_marks) const {
  const double signed_sweep_s = timing_.sweep_time_s(scan);
  scan.sweep_time_s = static_cast<float>(signed_sweep_s);
  const double sweep_s = std::abs(signed_sweep_s);
  if (!is_bent(scan)) return;
  std::optional<TPose2D> motion;
  if (!next_marks.empty()) motion = motion_between(mark, mark_like(mark, next_marks), sweep_s);
  if (!motion && !last_marks_.empty()) motion = motion_between(mark_like(mark, last_marks_), mark, sweep_s);
  if (!motion) return;
  if (*motion == TPose2D{0, 0, 0})
    scan.sweep_time_s = 0;  // a robot at rest bends no scan
  else
    scan = deskewed(scan, *motion);
}

bool DeskewedSource::is_bent(const LaserScan& scan) const {
  return std::abs(timing_.sweep_time_s(scan)) > 0 && scan.ranges_m.size() >= 2;
}

std::optional<Frame> DeskewedSource::read() {
  if (ended_) return std::nullopt;
  std::optional<Frame> frame;
  try {
    frame = source_->next();
  } catch (const UserError&) {
    failure_ = std::current_exception();
  }
  ended_ = !frame;
  return frame;
}

std::optional<Frame> DeskewedSource::next() {
  std::optional<Frame> frame = ahead_ ? std::exchange(ahead_, std::nullopt) : read();
  if (!frame) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::nullopt;
  }
  bool waits = is_bent(frame->scan);
  for (const CompanionScan& companion : frame->companions) waits = waits || is_bent(companion.scan);
  if (waits) ahead_ = read();
  Marks marks = marks_of(*frame);
  const Marks next_marks = ahead_ ? marks_of(*ahead_) : Marks{};
  straighten(frame->scan, marks[0], next_marks);
  for (std::size_t i = 0; i < frame->companions.size(); ++i)
    straighten(frame->companions[i].scan, marks[i + 1], next_marks);
  last_marks_ = std::move(marks);
  return frame;
}

}  // namespace psi_slam
