// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/simulation/simulated_log.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

constexpr double kVisits = 3;  // to each place
constexpr TimeUs kStart_us = 1'000'000'000;

}  // namespace

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
      people_(plan_, options.people, options.people_seed) {}

std::optional<Frame> SimulatedLog::next() {
  const std::optional<PathPose> pose = path_.next();
  if (!pose) return std::nullopt;
  Frame frame;
  frame.index = frames_++;
  frame.time_us = kStart_us + static_cast<TimeUs>(std::llround(pose->time_s * 1e6));
  frame.odom_T_robot = frame.index == 0 ? mrpt::math::TPose2D(0, 0, 0)
                                        : odometry_.move(pose->world_T_robot - now_.world_T_robot);
  frame.scan = scanner_.scan(pose->world_T_robot, people_.at(pose->time_s), frame.index);
  now_ = *pose;
  return frame;
}

double SimulatedLog::progress() const {
  return std::clamp(now_.travelled_m / options_.path.path_m, 0.0, 1.0);
}

}  // namespace psi_slam
