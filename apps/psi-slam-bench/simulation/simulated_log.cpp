// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_log.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

constexpr double kSlowest_m_s = 0.7;
constexpr double kFastest_m_s = 1.5;
constexpr double kFromWall_m = 0.3;  // least gap between the wall and a person

constexpr TimeUs kStart_us = 1'000'000'000;

}  // namespace

WalkingPeople::WalkingPeople(const FloorPlan& plan, std::size_t count, std::uint64_t seed) {
  SimulationRandom random(seed, SimulationRandom::Stream::kPeople);
  for (std::size_t i = 0; i < count; ++i) {
    const Corridor& corridor = plan.corridors[random.index(plan.corridors.size())];
    const mrpt::math::TPoint2D way = corridor.to - corridor.from;
    const double length = portable::hypot(way.x, way.y);
    const double aside =
        random.between(-1, 1) * std::max(0.0, corridor.width_m / 2 - kFromWall_m - kPersonRadius_m);
    const mrpt::math::TPoint2D off(-aside * way.y / length, aside * way.x / length);
    const double speed = random.between(kSlowest_m_s, kFastest_m_s);
    people_.push_back({corridor.from + off, corridor.to + off, speed, random.between(0, 2 * length)});
  }
}

std::vector<mrpt::math::TPoint2D> WalkingPeople::at(double time_s) const {
  std::vector<mrpt::math::TPoint2D> points;
  for (const Person& person : people_) {
    const mrpt::math::TPoint2D way = person.to - person.from;
    const double length = portable::hypot(way.x, way.y);
    const double gone = std::fmod(person.start_m + person.speed_m_s * time_s, 2 * length);
    const double share = std::min(gone, 2 * length - gone) / length;
    points.push_back(person.from + way * share);
  }
  return points;
}

mrpt::math::TPose2D WheelOdometry::move(const mrpt::math::TPose2D& before_T_now) {
  const double way_m = portable::hypot(before_T_now.x, before_T_now.y);
  const double turned_rad = std::abs(before_T_now.phi);
  const double root_m = std::sqrt(way_m);
  const double length_error_m = options_.sigma_m_per_root_m * root_m * random_.normal();
  const double drift_rad = options_.sigma_rad_per_root_m * root_m * random_.normal();
  const double turn_error_rad = options_.sigma_rad_per_root_rad * std::sqrt(turned_rad) * random_.normal();
  const double longer_m = (options_.length_scale - 1) * way_m + length_error_m;
  const double stretch = way_m > 0 ? 1 + longer_m / way_m : 1;
  const double turn = options_.turn_scale * before_T_now.phi + drift_rad + turn_error_rad;
  odom_T_robot_ =
      compose(odom_T_robot_, mrpt::math::TPose2D(stretch * before_T_now.x, stretch * before_T_now.y, turn));
  odom_T_robot_.normalizePhi();
  return odom_T_robot_;
}

SimulatedLogOptions simulated_log_options(double path_m, std::uint64_t seed) {
  SimulatedLogOptions options;
  options.plan.corridors_m = path_m / kVisits;
  options.path.path_m = path_m;
  options.plan.seed = options.path.seed = options.scan.seed = options.odometry.seed = seed;
  options.people_seed = seed;
  return options;
}

SimulatedLog::SimulatedLog(const SimulatedLogOptions& options)
    : options_(options),
      plan_(draw_floor_plan(options.plan)),
      path_(plan_, options.path),
      scanner_(plan_, options.scan),
      odometry_(options.odometry),
      people_(plan_, options.people, options.people_seed) {
  for (const FurtherLaser& laser : options.further_lasers) {
    if (!(laser.delay_s >= 0 && laser.delay_s * options.path.scan_rate_hz < 1))
      throw std::invalid_argument(
          "SimulatedLog: a laser's delay is negative, or not below the time between scans");
    further_scanners_.emplace_back(plan_, laser.scan);
  }
}

std::optional<SimulatedLog::Stop> SimulatedLog::next_stop() {
  const std::optional<PathPose> path = path_.next();
  if (!path) return std::nullopt;
  Stop stop{*path, {0, 0, 0}};
  if (last_stop_)
    stop.odom_T_robot = odometry_.move(between(last_stop_->path.world_T_robot, path->world_T_robot));
  last_stop_ = stop;
  return stop;
}

CompanionScan SimulatedLog::scan_between(std::size_t laser, const Stop& now, const Stop& next) {
  const double delay_s = options_.further_lasers[laser].delay_s;
  const double period_s = next.path.time_s - now.path.time_s;
  const double share = period_s > 0 ? delay_s / period_s : 0;
  const mrpt::math::TPose2D world_T_robot =
      interpolate(now.path.world_T_robot, next.path.world_T_robot, share);
  CompanionScan companion;
  companion.time_us = kStart_us + static_cast<TimeUs>(std::llround((now.path.time_s + delay_s) * 1e6));
  companion.frame_T_robot =
      between(now.odom_T_robot, interpolate(now.odom_T_robot, next.odom_T_robot, share));
  companion.scan =
      further_scanners_[laser].scan(world_T_robot, people_.at(now.path.time_s + delay_s), frames_);
  companion.scan.laser = laser + 1;
  return companion;
}

std::optional<Frame> SimulatedLog::next() {
  const std::optional<Stop> now = ahead_ ? std::exchange(ahead_, std::nullopt) : next_stop();
  if (!now) return std::nullopt;
  Frame frame;
  frame.time_us = kStart_us + static_cast<TimeUs>(std::llround(now->path.time_s * 1e6));
  frame.odom_T_robot = now->odom_T_robot;
  frame.scan = scanner_.scan(now->path.world_T_robot, people_.at(now->path.time_s), frames_);
  if (!further_scanners_.empty()) ahead_ = next_stop();
  for (std::size_t laser = 0; laser < further_scanners_.size(); ++laser)
    frame.companions.push_back(scan_between(laser, *now, ahead_.value_or(*now)));
  frame.index = frames_++;
  now_ = now->path;
  return frame;
}

double SimulatedLog::progress() const {
  return std::clamp(now_.travelled_m / options_.path.path_m, 0.0, 1.0);
}

}  // namespace psi_slam
