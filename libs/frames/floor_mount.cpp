// SPDX-License-Identifier: BSD-3-Clause
#include "frames/floor_mount.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

const double kMaxTilt_rad = mrpt::DEG2RAD(15.0);

/// The angle between the laser's plane and the floor, in [0, pi/2].
double tilt_rad(const mrpt::math::CMatrixDouble33& rotation) {
  return std::acos(std::min(1.0, std::abs(rotation(2, 2))));
}

}  // namespace

FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place) {
  const mrpt::math::CMatrixDouble33 rotation = robot_T_laser.getRotationMatrix();
  if (tilt_rad(rotation) > kMaxTilt_rad) {
    char degrees[32];
    std::snprintf(degrees, sizeof degrees, "%.0f", mrpt::RAD2DEG(tilt_rad(rotation)));
    throw UserError(place + ": the laser is tilted by " + degrees +
                    " degrees, expected one that looks along the floor to 15 degrees");
  }
  return {{robot_T_laser.x(), robot_T_laser.y(), std::atan2(rotation(1, 0), rotation(0, 0))},
          rotation(2, 2) < 0};
}

}  // namespace psi_slam
