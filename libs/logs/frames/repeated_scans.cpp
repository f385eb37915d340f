// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/repeated_scans.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr std::size_t kRemembered = 8;  // readings of a laser; drivers repeat what is in their buffers
constexpr std::size_t kFewestSeen = 5;  // different readings; otherwise, they may not depend on the place
constexpr std::size_t kFewestSteps = 10;
// A robot that moves farther in a second does not stand: odometry of a standing robot, and the heading by its
// gyroscope, drift less.
constexpr double kStanding_m = 0.01;
const double kStanding_rad = DEG2RAD(0.5);
const double kStandingByGyroscope_rad = DEG2RAD(2.0);
constexpr TimeUs kStanding_us = 1'000'000;
constexpr double kDriftShare = 0.1;            // largest error of odometry, as a share of path and turns
const double kDriftOnPath_rad = DEG2RAD(1.0);  // largest error of the heading for each metre
constexpr double kSameRange_m = 0.015;         // simulators round ranges to 1 cm
constexpr double kSameHeading_rad = 0.002;     // error of odometry from one scan to the next
constexpr double kMostDifferent = 0.02;
constexpr std::size_t kBeams = 200;  // that are compared

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Returns whether a scan shows a shape: some neighbouring returns differ. Scans without returns, or with
/// codes for "no return" only, are alike wherever the robot is.
bool shows_shape(const std::vector<float>& ranges_m) {
  std::size_t steps = 0;
  for (std::size_t i = 1; i < ranges_m.size(); ++i)
    if (std::isfinite(ranges_m[i - 1]) && std::isfinite(ranges_m[i]) && ranges_m[i] != ranges_m[i - 1])
      ++steps;
  return steps >= kFewestSteps;
}

struct Segment {
  Eigen::Vector2d from_m;
  Eigen::Vector2d to_m;
};

/// Walls between neighbouring returns of each `step`-th beam, in the laser's frame.
std::vector<Segment> walls_of(const LaserScan& scan, std::size_t step) {
  const auto point = [&](std::size_t i) -> Eigen::Vector2d {
    const auto [sin, cos] = portable::sin_cos(static_cast<double>((*scan.bearings_rad)[i]));
    return static_cast<double>(scan.ranges_m[i]) * Eigen::Vector2d(cos, sin);
  };
  std::vector<Segment> walls;
  for (std::size_t i = step; i < scan.ranges_m.size(); i += step)
    if (std::isfinite(scan.ranges_m[i - step]) && std::isfinite(scan.ranges_m[i]))
      walls.push_back({point(i - step), point(i)});
  return walls;
}

/// Distance of the end of a ray of the length `range_m` from the nearest wall on the ray, across that wall,
/// metres. Empty if the ray hits none.
std::optional<double> off_wall_m(const std::vector<Segment>& walls, const TPose2D& ray, double range_m) {
  const auto [sin, cos] = portable::sin_cos(ray.phi);
  double nearest_m = std::numeric_limits<double>::infinity();
  std::optional<double> off_m;
  for (const Segment& wall : walls) {
    const Eigen::Vector2d along = wall.to_m - wall.from_m;
    const Eigen::Vector2d to_wall = wall.from_m - Eigen::Vector2d(ray.x, ray.y);
    const double cross = cos * along.y() - sin * along.x();
    const double hit_m = (to_wall.x() * along.y() - to_wall.y() * along.x()) / cross;
    const double share = (to_wall.x() * sin - to_wall.y() * cos) / cross;
    if (!(hit_m > 0 && hit_m < nearest_m && share >= 0 && share <= 1)) continue;
    nearest_m = hit_m;
    off_m = std::abs((range_m - hit_m) * cross) / along.norm();
  }
  return off_m;
}

/// Returns whether a laser would measure nearly the same after `motion` of the robot, as in a bare corridor.
bool looks_the_same_after(const TPose2D& motion, const LaserScan& scan) {
  const std::size_t step = scan.ranges_m.size() / kBeams + 1;
  const std::vector<Segment> walls = walls_of(scan, step);
  const TPose2D laser = between(scan.robot_T_laser, compose(motion, scan.robot_T_laser));
  std::size_t compared = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); i += step) {
    const double bearing_rad = static_cast<double>((*scan.bearings_rad)[i]);
    const auto range_m = static_cast<double>(scan.ranges_m[i]);
    if (!std::isfinite(range_m)) continue;
    const auto off_m = off_wall_m(walls, compose(laser, {0, 0, bearing_rad}), range_m);
    if (!off_m) continue;
    ++compared;
    if (*off_m > kSameRange_m + kSameHeading_rad * range_m) ++different;
  }
  return static_cast<double>(different) <= kMostDifferent * static_cast<double>(compared);
}

}  // namespace

void RepeatedScans::travel(const Frame& frame) {
  if (!has_last_) begin_us_ = frame.time_us;
  if (has_last_ && frame.has_odometry && last_.has_odometry) {
    const TPose2D step = between(last_.odom_T_robot, frame.odom_T_robot);
    path_m_ += step.norm();
    turned_rad_ += std::abs(wrapToPi(step.phi));
  }
  has_last_ = true;
  last_.odom_T_robot = frame.odom_T_robot;
  last_.has_odometry = frame.has_odometry;
}

bool RepeatedScans::is_elsewhere(const Seen& seen, const Frame& frame) const {
  const Frame& then = seen.frame;
  if (frame.has_odometry && then.has_odometry) {
    TPose2D motion = between(then.odom_T_robot, frame.odom_T_robot);
    motion.phi = wrapToPi(motion.phi);
    const bool may_be_back = motion.norm() <= kStanding_m + kDriftShare * (path_m_ - seen.path_m) &&
                             std::abs(motion.phi) <= kStanding_rad +
                                                         kDriftShare * (turned_rad_ - seen.turned_rad) +
                                                         kDriftOnPath_rad * (path_m_ - seen.path_m);
    return !may_be_back && !looks_the_same_after(motion, frame.scan);
  }
  if (!frame.imu_heading_rad || !then.imu_heading_rad) return false;
  const double turn_rad = std::remainder(*frame.imu_heading_rad - *then.imu_heading_rad, 2 * M_PI);
  return std::abs(turn_rad) > kStandingByGyroscope_rad && !looks_the_same_after({0, 0, turn_rad}, frame.scan);
}

RepeatedScans::Judgement RepeatedScans::judge(const Frame& frame) {
  travel(frame);
  if (!shows_shape(frame.scan.ranges_m)) return Judgement::kNew;
  std::deque<Seen>& seen = seen_[frame.scan.laser];
  const auto same = std::find_if(seen.rbegin(), seen.rend(), [&](const Seen& before) {
    return same_bits(before.frame.scan.ranges_m, frame.scan.ranges_m);
  });
  if (same == seen.rend()) {
    seen.push_back({frame, path_m_, turned_rad_});
    if (seen.size() > kRemembered) seen.pop_front();
    return Judgement::kNew;
  }
  if (is_elsewhere(*same, frame))
    return shows_change(frame.scan.laser) ? Judgement::kRepeats : Judgement::kPerhaps;
  if (frame.time_us - same->frame.time_us > kStanding_us) *same = {frame, path_m_, turned_rad_};
  return Judgement::kNew;
}

bool RepeatedScans::repeats(const Frame& frame) {
  const bool repeats = judge(frame) == Judgement::kRepeats;
  if (repeats) count(frame);
  return repeats;
}

bool RepeatedScans::shows_change(std::size_t laser) const {
  const auto seen = seen_.find(laser);
  return seen != seen_.end() && seen->second.size() >= kFewestSeen;
}

void RepeatedScans::count(const Frame& frame) {
  if (count_++ == 0) first_us_ = frame.time_us;
  last_us_ = frame.time_us;
}

std::string RepeatedScans::sentence() const {
  if (count_ == 0) return {};
  const auto moment = [&](TimeUs time_us) { return fixed_text(seconds(time_us - begin_us_), 1) + " s"; };
  return counted(count_, "scan") + (count_ == 1 ? " repeats" : " repeat") +
         " the readings of an earlier scan although the robot moved (" +
         (count_ == 1 ? moment(first_us_)
                      : "the first " + moment(first_us_) + ", the last " + moment(last_us_)) +
         " into the log), so " + (count_ == 1 ? "it is" : "they are") +
         " left out: the laser stalled, or its driver publishes scans twice";
}

}  // namespace psi_slam
