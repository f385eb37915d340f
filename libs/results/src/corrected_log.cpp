// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/results/corrected_log.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "psi_slam/base/atomic_file.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/results/number_text.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHost = "psi-slam";

/// FLASER has no bearings: its ranges go counter-clockwise, those of a laser that hangs upside down do not.
bool runs_clockwise(const LaserScan& scan) {
  return scan.bearings_rad && scan.bearings_rad->size() > 1 &&
         scan.bearings_rad->front() > scan.bearings_rad->back();
}

double degrees(double radians) {
  return radians * (180 / M_PI);
}

/// What the FLASER lines cannot say about the sensor.
std::string heading(const LaserScan& scan) {
  const auto& mount = scan.robot_T_laser;
  std::string text = "# corrected log: FLASER n ranges  x y theta (map)  odom_x odom_y odom_theta  ";
  text += "timestamp host logger_timestamp\n";
  text += "# laser on the robot: x " + fixed_text(mount.x, 6) + " m, y " + fixed_text(mount.y, 6) +
          " m, yaw " + fixed_text(mount.phi, 6) + " rad\n";
  text += "PARAM robot_frontlaser_offset " + fixed_text(mount.x, 6) + '\n';
  text += "PARAM robot_frontlaser_side_offset " + fixed_text(mount.y, 6) + '\n';
  text += "PARAM robot_frontlaser_angular_offset " + fixed_text(mount.phi, 9) + '\n';
  text += "PARAM robot_front_laser_max " + shortest_text(scan.max_range_m) + '\n';
  if (scan.bearings_rad && scan.bearings_rad->size() > 1) {
    const std::size_t beams = scan.bearings_rad->size();
    double first = degrees(static_cast<double>(scan.bearings_rad->front()));
    double last = degrees(static_cast<double>(scan.bearings_rad->back()));
    if (runs_clockwise(scan)) std::swap(first, last);
    text += "# beams: " + std::to_string(beams) + ", from " + fixed_text(first, 4) + " to " +
            fixed_text(last, 4) + " degrees\n";
    text += "PARAM laser_front_laser_resolution " +
            fixed_text((last - first) / static_cast<double>(beams - 1), 4) + '\n';
  }
  return text;
}

void append_pose(std::string& line, const mrpt::math::TPose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.phi}) line += ' ' + fixed_text(value, 9);
}

std::string flaser_line(const Frame& frame, const mrpt::math::TPose2D& map_T_robot) {
  std::vector<float> ranges_m = frame.scan.ranges_m;
  if (runs_clockwise(frame.scan)) std::reverse(ranges_m.begin(), ranges_m.end());
  std::string line = "FLASER " + std::to_string(ranges_m.size());
  for (const float range_m : ranges_m)
    line += ' ' + shortest_text(std::isfinite(range_m) ? range_m : frame.scan.max_range_m);
  append_pose(line, map_T_robot);
  append_pose(line, frame.odom_T_robot);
  const std::string stamp = format_seconds(frame.time_us);
  line += ' ' + stamp + ' ' + kHost + ' ' + stamp + '\n';
  return line;
}

}  // namespace

void write_corrected_log(const fs::path& path, const std::vector<Frame>& log,
                         const std::vector<mrpt::math::TPose2D>& map_T_robot) {
  if (log.size() != map_T_robot.size())
    throw std::invalid_argument("write_corrected_log: " + std::to_string(log.size()) + " scans but " +
                                std::to_string(map_T_robot.size()) + " poses");
  write_atomically(path, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    if (!log.empty()) file << heading(log.front().scan);
    for (std::size_t i = 0; i < log.size() && file; ++i) file << flaser_line(log[i], map_T_robot[i]);
    file.close();
    if (!file)
      throw SystemFailure("cannot write " + path.string() + ": " +
                          (errno != 0 ? std::strerror(errno) : "the disk did not take it"));
  });
}

}  // namespace psi_slam
