// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/odometry_noise.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kStretch_m = 1;
constexpr double kStretch_rad = 1;

/// What odometry makes of a stretch.
struct StretchError {
  double way_m = 0;
  double turn_rad = 0;  // back and forth added up
  double squared_m2 = 0;
  double squared_rad2 = 0;
};

std::vector<StretchError> stretch_errors(const std::vector<TPose2D>& odom_T_robot,
                                         const std::vector<TPose2D>& map_T_robot) {
  std::vector<StretchError> errors;
  StretchError stretch;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < map_T_robot.size(); ++i) {
    const TPose2D step = map_T_robot[i] - map_T_robot[i - 1];
    stretch.way_m += std::hypot(step.x, step.y);
    stretch.turn_rad += std::abs(mrpt::math::wrapToPi(step.phi));
    if (stretch.way_m < kStretch_m && stretch.turn_rad < kStretch_rad) continue;
    const TPose2D off = (odom_T_robot[i] - odom_T_robot[begin]) - (map_T_robot[i] - map_T_robot[begin]);
    const double off_rad = mrpt::math::wrapToPi(off.phi);
    stretch.squared_m2 = off.x * off.x + off.y * off.y;
    stretch.squared_rad2 = off_rad * off_rad;
    errors.push_back(stretch);
    stretch = {};
    begin = i;
  }
  return errors;
}

/// Variances a metre and a radian: the least squares of squared_rad2 = a way + b turn, neither negative.
void split_heading(const std::vector<StretchError>& errors, OdometryNoise& noise) {
  double ww = 0, wt = 0, tt = 0, we = 0, te = 0;
  for (const StretchError& error : errors) {
    ww += error.way_m * error.way_m;
    wt += error.way_m * error.turn_rad;
    tt += error.turn_rad * error.turn_rad;
    we += error.way_m * error.squared_rad2;
    te += error.turn_rad * error.squared_rad2;
  }
  const double determinant = ww * tt - wt * wt;
  double a = determinant > 1e-9 * ww * tt ? (we * tt - te * wt) / determinant : -1;
  double b = determinant > 1e-9 * ww * tt ? (te * ww - we * wt) / determinant : -1;
  if (a < 0 || b < 0) {  // one of them explains more than all: the other is nothing
    const bool way_only = a >= 0 || (b < 0 && ww >= tt);
    a = way_only && ww > 0 ? we / ww : 0;
    b = !way_only && tt > 0 ? te / tt : 0;
  }
  noise.sigma_rad_per_root_m = std::sqrt(a);
  noise.sigma_rad_per_root_rad = std::sqrt(b);
}

}  // namespace

OdometryNoise measure_odometry_noise(const std::vector<TPose2D>& odom_T_robot,
                                     const std::vector<TPose2D>& map_T_robot) {
  if (odom_T_robot.size() != map_T_robot.size())
    throw std::invalid_argument("measure_odometry_noise: a pose of odometry for each pose of the map");
  const std::vector<StretchError> errors = stretch_errors(odom_T_robot, map_T_robot);
  OdometryNoise noise;
  double way_m = 0;
  double squared_m2 = 0;
  for (const StretchError& error : errors) {
    way_m += error.way_m;
    squared_m2 += error.squared_m2;
  }
  if (way_m > 0) noise.sigma_m_per_root_m = std::sqrt(squared_m2 / (2 * way_m));
  split_heading(errors, noise);
  return noise;
}

}  // namespace psi_slam
