// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_mount.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>

#include "compression/line_reader.h"
#include "carmen/carmen_message.h"

namespace psi_slam {
namespace {

constexpr double kEnoughPath_m = 3.0;
constexpr double kEnoughTurn_rad = 1.0;
constexpr double kSameMount_m = 0.002;  // logs are written to a micrometre or a millimetre
constexpr double kSameMount_rad = 0.002;

bool same_mount(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) <= kSameMount_m &&
         std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) <= kSameMount_rad;
}

std::optional<CarmenLaserMessage> readable_robotlaser(CarmenFields& fields) {
  try {
    return read_robotlaser(fields);
  } catch (const MalformedLine&) {  // whoever reads the log tells of it
    return std::nullopt;
  }
}

}  // namespace

std::optional<mrpt::math::TPose2D> mount_by_robotlaser(const std::filesystem::path& path,
                                                       std::string_view message) {
  LineReader lines(path);
  std::optional<mrpt::math::TPose2D> mount;
  std::optional<mrpt::math::TPose2D> last_robot;
  double path_m = 0;
  double turn_rad = 0;
  std::string_view line;
  while (path_m < kEnoughPath_m && turn_rad < kEnoughTurn_rad && lines.next_readable(line)) {
    CarmenFields fields(line, lines);
    if (fields.message() != message) continue;
    const auto laser = readable_robotlaser(fields);
    if (!laser) continue;
    const mrpt::math::TPose2D robot_T_laser = laser->odom_T_laser - laser->odom_T_robot;
    if (mount && !same_mount(*mount, robot_T_laser)) return std::nullopt;
    if (!mount) mount = robot_T_laser;
    if (last_robot) {
      path_m += std::hypot(laser->odom_T_robot.x - last_robot->x, laser->odom_T_robot.y - last_robot->y);
      turn_rad += std::abs(mrpt::math::wrapToPi(laser->odom_T_robot.phi - last_robot->phi));
    }
    last_robot = laser->odom_T_robot;
  }
  return mount;
}

}  // namespace psi_slam
